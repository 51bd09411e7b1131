#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace hvas::studio {

/** Certificate and private key of a server: PEM files, which may be one file. */
struct TlsFiles {
  std::filesystem::path certificate;  ///< The certificate, followed by its chain.
  std::filesystem::path key;
};

/** A self-signed certificate, which people verify by its fingerprint. */
struct SelfSigned {
  TlsFiles files;
  std::string fingerprint;  ///< Result of CalcFingerprint.
  bool is_new{false};  ///< Made by this call: browsers that trusted the previous one ask again.
};

/** Finds the folder of the user's certificate: $XDG_STATE_HOME/hvas, else ~/.local/state/hvas.
 Errors: kNotFound when neither variable is set. */
[[nodiscard]] Result<std::filesystem::path> FindCertificateFolder();

/** Finds or makes the self-signed certificate for these names in a folder: one file with its key,
 readable by this user only. It is made when there is none, and again when it expires within two
 weeks or lacks a name: ECDSA on P-256, valid for a year.
 @param names  Host names and addresses, at least one.
 @param now_s  Unix time [s].
 Errors: kUnreadable when the file holds something else; kInvalid when other users can read it or a
 name is malformed; those of WriteAtomically. */
[[nodiscard]] Result<SelfSigned> EnsureCertificate(const std::filesystem::path& folder,
                                                   const std::vector<std::string>& names,
                                                   std::int64_t now_s);

/** Computes the SHA-256 fingerprint of the first certificate of a PEM file, as browsers show it:
 "0A:1B:..". Errors: kUnreadable when there is no certificate in it. */
[[nodiscard]] Result<std::string> CalcFingerprint(const std::filesystem::path& certificate);

/** Lists the names of a machine that listens at an address: the address itself, or, for the
 unspecified address ("0.0.0.0", "::"), all addresses that other machines can reach; then the
 machine's host name. Errors: kInvalid for a malformed address. */
[[nodiscard]] Result<std::vector<std::string>> ListNamesOf(const std::string& address);

}  // namespace hvas::studio
