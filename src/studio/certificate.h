#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace hvas::studio {

/** What a server shows to prove who it is: PEM files, which may be one and the same. */
struct TlsFiles {
  std::filesystem::path certificate;  ///< With those that signed it behind it.
  std::filesystem::path key;
};

/** A certificate that nobody but its key has signed: people compare its fingerprint. */
struct SelfSigned {
  TlsFiles files;
  std::string fingerprint;  ///< As CalcFingerprint.
  bool is_new{false};       ///< Browsers that trusted the one before ask again.
};

/** Where a user's own certificate is: $XDG_STATE_HOME/hvas, else ~/.local/state/hvas.
 Errors (kNotFound): there is no home. */
[[nodiscard]] Result<std::filesystem::path> FindCertificateFolder();

/** The certificate for these names that is kept in a folder, in one file with its key that nobody
 but the user can read. It is made when there is none, and anew when it ends within two weeks or
 lacks a name: ECDSA on P-256, for a year.
 @param names  Host names and addresses, at least one.
 @param now_s  Unix time [s].
 Errors: kUnreadable when the file there holds something else, kInvalid when others can read it or
 a name is none; those of writing a file. */
[[nodiscard]] Result<SelfSigned> KeepCertificate(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& names,
                                                 std::int64_t now_s);

/** SHA-256 of the first certificate of a PEM file, as browsers show it: "0A:1B:..".
 Errors (kUnreadable): there is none. */
[[nodiscard]] Result<std::string> CalcFingerprint(const std::filesystem::path& certificate);

/** Of a machine that listens at an address: the address itself, or, where it stands for all of
 them ("0.0.0.0", "::"), all that others can reach it by; then the machine's name.
 Errors (kInvalid): this is no address. */
[[nodiscard]] Result<std::vector<std::string>> ListNamesOf(const std::string& address);

}  // namespace hvas::studio
