#include "studio/certificate.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <optional>
#include <system_error>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include "base/atomic_file.h"
#include "base/regular_file.h"
#include "base/user_folder.h"

namespace hvas::studio {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kDayS = 86'400;      // Seconds of a day.
constexpr std::int64_t kValidDays = 397;    // the longest validity that browsers accept
constexpr std::int64_t kRenewedDays = 14;   // time before expiry
constexpr std::int64_t kBackdatedDays = 1;  // allows for clocks that are behind

template <auto kFree>
struct Free {
  template <typename T>
  void operator()(T* value) const {
    kFree(value);
  }
};

using Bio = std::unique_ptr<BIO, Free<BIO_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using X509Ptr = std::unique_ptr<X509, Free<X509_free>>;

bool IsAddress(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

/** Whether a name has the syntax of DNS host names. */
bool IsHostName(const std::string& name) {
  constexpr std::size_t kLongest = 253;  // Letters of a name (RFC 1035).
  return !name.empty() && name.size() <= kLongest && name.front() != '.' && name.front() != '-' &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '.'; });
}

Bio MakeBio(std::string_view bytes) {
  return Bio(BIO_new_mem_buf(bytes.data(), static_cast<int>(bytes.size())));
}

/** Password callback of OpenSSL that gives none, so that nobody is prompted. */
int RefusePassword(char* /*password*/, int /*size*/, int /*is_new*/, void* /*user*/) {
  return 0;
}

X509Ptr ReadCertificate(std::string_view pem) {
  return X509Ptr(PEM_read_bio_X509(MakeBio(pem).get(), nullptr, RefusePassword, nullptr));
}

Key ReadKey(std::string_view pem) {
  return Key(PEM_read_bio_PrivateKey(MakeBio(pem).get(), nullptr, RefusePassword, nullptr));
}

bool HasName(X509* certificate, const std::string& name) {
  return IsAddress(name) ? X509_check_ip_asc(certificate, name.c_str(), 0) == 1
                         : X509_check_host(certificate, name.c_str(), name.size(), 0, nullptr) == 1;
}

bool ExpiresBefore(const X509* certificate, std::int64_t time_s) {
  std::time_t time = time_s;
  return X509_cmp_time(X509_get0_notAfter(certificate), &time) <= 0;
}

bool AddExtension(X509* certificate, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, Free<X509_EXTENSION_free>> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  return extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1;
}

bool SetSerial(X509* certificate) {
  constexpr int kBits = 127;  // Positive, and less than the 160 that X.509 allows.
  const std::unique_ptr<BIGNUM, Free<BN_free>> number(BN_new());
  return number != nullptr &&
         BN_rand(number.get(), kBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr;
}

bool SetNames(X509* certificate, const std::vector<std::string>& names) {
  std::vector<std::string> alternatives;
  for (const std::string& name : names) {
    alternatives.push_back(fmt::format("{}:{}", IsAddress(name) ? "IP" : "DNS", name));
  }
  const auto* common = reinterpret_cast<const unsigned char*>("HVAS studio");
  X509_NAME* subject = X509_get_subject_name(certificate);
  return X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, common, -1, -1, 0) == 1 &&
         X509_set_issuer_name(certificate, subject) == 1 &&
         AddExtension(certificate, NID_subject_alt_name,
                      fmt::format("{}", fmt::join(alternatives, ",")));
}

/** Makes key and certificate in one text, so that they are replaced together; empty when OpenSSL
 fails for lack of random numbers or memory. */
std::string MakePem(const std::vector<std::string>& names, std::int64_t now_s) {
  const Key key(EVP_EC_gen("P-256"));
  const X509Ptr certificate(X509_new());
  std::time_t now = now_s;
  const bool is_made =
      key != nullptr && certificate != nullptr &&
      X509_set_version(certificate.get(), X509_VERSION_3) == 1 && SetSerial(certificate.get()) &&
      X509_time_adj_ex(X509_getm_notBefore(certificate.get()), -kBackdatedDays, 0, &now) !=
          nullptr &&
      X509_time_adj_ex(X509_getm_notAfter(certificate.get()), kValidDays, 0, &now) != nullptr &&
      X509_set_pubkey(certificate.get(), key.get()) == 1 && SetNames(certificate.get(), names) &&
      AddExtension(certificate.get(), NID_basic_constraints, "critical,CA:FALSE") &&
      AddExtension(certificate.get(), NID_key_usage, "critical,digitalSignature") &&
      AddExtension(certificate.get(), NID_ext_key_usage, "serverAuth") &&
      X509_sign(certificate.get(), key.get(), EVP_sha256()) > 0;
  const Bio out(BIO_new(BIO_s_mem()));
  if (!is_made || out == nullptr ||
      PEM_write_bio_PKCS8PrivateKey(out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) !=
          1 ||
      PEM_write_bio_X509(out.get(), certificate.get()) != 1) {
    return "";
  }
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(out.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

std::string FingerprintOf(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  X509_digest(certificate, EVP_sha256(), digest.data(), &size);
  return fmt::format("{:02X}", fmt::join(digest.begin(), digest.begin() + size, ":"));
}

Result<void> CheckNames(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!IsAddress(name) && !IsHostName(name)) {
      return Fail(ErrorCode::kInvalid, "this is neither a host name nor an address", name,
                  "give a name such as studio.example, or an address such as 192.168.1.5");
    }
  }
  return {};
}

/** Finds the certificate in a file; none when there is none, or when it expires too soon or lacks a
 name. */
Result<std::optional<SelfSigned>> FindKept(const fs::path& file,
                                           const std::vector<std::string>& names,
                                           std::int64_t now_s) {
  struct stat status {};

  if (::stat(file.c_str(), &status) != 0 && errno == ENOENT) {
    return std::nullopt;
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Fail(ErrorCode::kInvalid, "other users can read this key", file.string(),
                fmt::format("delete it to get a new one, or run: chmod 600 '{}'", file.string()));
  }
  const std::string pem = ReadRegularFile(file).value_or(std::string());
  const X509Ptr certificate = ReadCertificate(pem);
  const Key key = ReadKey(pem);
  if (certificate == nullptr || key == nullptr ||
      X509_check_private_key(certificate.get(), key.get()) != 1) {
    return Fail(ErrorCode::kUnreadable, "the file is not a certificate with its key", file.string(),
                "delete it; the studio makes a new one");
  }
  const bool has_names = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return HasName(certificate.get(), name);
  });
  if (!has_names || ExpiresBefore(certificate.get(), now_s + kRenewedDays * kDayS)) {
    return std::nullopt;
  }
  return SelfSigned{{file, file}, FingerprintOf(certificate.get()), false};
}

Result<void> MakeFolder(const fs::path& folder) {
  std::error_code failed;
  if (fs::create_directories(folder, failed)) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  return failed ? Result<void>(Fail(ErrorCode::kOutOfResource,
                                    "this folder cannot be made: " + failed.message(),
                                    folder.string(), "set XDG_STATE_HOME to a writable folder"))
                : Result<void>();
}

/** Formats an address; none for families other than IPv4 and IPv6, and for link-local IPv6. */
std::optional<std::string> FormatAddress(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address == nullptr) {
    return std::nullopt;
  }
  if (address->sa_family == AF_INET) {
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(address);
    return ::inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
  }
  if (address->sa_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(address);
    if (!IN6_IS_ADDR_LINKLOCAL(&v6->sin6_addr)) {  // browsers do not accept zone ids
      return ::inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
    }
  }
  return std::nullopt;
}

/** Lists the addresses of all interfaces that are up, except the loopback. */
std::vector<std::string> ListAddresses(bool has_v6) {
  std::vector<std::string> addresses;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) {
    return addresses;
  }
  const std::unique_ptr<ifaddrs, Free<::freeifaddrs>> owner(list);
  for (const ifaddrs* at = list; at != nullptr; at = at->ifa_next) {
    const bool is_reached = (at->ifa_flags & IFF_UP) != 0 && (at->ifa_flags & IFF_LOOPBACK) == 0;
    const auto address = FormatAddress(at->ifa_addr);
    if (is_reached && address && (has_v6 || at->ifa_addr->sa_family == AF_INET)) {
      addresses.push_back(*address);
    }
  }
  return addresses;
}

}  // namespace

Result<fs::path> FindCertificateFolder() {
  if (const auto folder = FindUserFolder("XDG_STATE_HOME", ".local/state")) {
    return *folder;
  }
  return Fail(ErrorCode::kNotFound, "there is no home folder for the certificate", "HOME",
              "set XDG_STATE_HOME to a folder, or give --certificate and --key");
}

Result<SelfSigned> EnsureCertificate(const fs::path& folder, const std::vector<std::string>& names,
                                     std::int64_t now_s) {
  if (const auto checked = CheckNames(names); !checked) {
    return Unexpected(checked.error());
  }
  const fs::path file = folder / "studio.pem";
  auto kept = FindKept(file, names, now_s);
  if (!kept) {
    return Unexpected(kept.error());
  }
  if (*kept) {
    return **kept;
  }
  const std::string pem = MakePem(names, now_s);
  if (pem.empty()) {
    return Fail(ErrorCode::kInternal, "OpenSSL could not make a certificate", file.string(),
                "give --certificate and --key");
  }
  if (const auto made = MakeFolder(folder); !made) {
    return Unexpected(made.error());
  }
  if (const auto written = WriteAtomically(file, pem, FileReaders::kOwner); !written) {
    return Unexpected(written.error());
  }
  return SelfSigned{{file, file}, FingerprintOf(ReadCertificate(pem).get()), true};
}

Result<std::string> CalcFingerprint(const fs::path& certificate) {
  const Result<std::string> text = ReadRegularFile(certificate);
  if (!text) {
    return Unexpected(text.error());
  }
  const X509Ptr read = ReadCertificate(*text);
  if (read == nullptr) {
    return Fail(ErrorCode::kUnreadable, "the file has no certificate in PEM format",
                certificate.string(), "give the file that begins with -----BEGIN CERTIFICATE-----");
  }
  return FingerprintOf(read.get());
}

Result<std::vector<std::string>> ListNamesOf(const std::string& address) {
  if (!IsAddress(address)) {
    return Fail(ErrorCode::kInvalid, "this is not an IP address", address,
                "give an address of this machine, or 0.0.0.0 for all of them");
  }
  std::vector<std::string> names{address};
  if (address == "0.0.0.0" || address == "::") {
    names = ListAddresses(address == "::");
  }
  constexpr std::size_t kLongest = 256;  // HOST_NAME_MAX is 64 here, 255 in POSIX.
  std::array<char, kLongest> own{};
  if (::gethostname(own.data(), own.size() - 1) == 0 && IsHostName(own.data())) {
    names.emplace_back(own.data());
  }
  return names;
}

}  // namespace hvas::studio
