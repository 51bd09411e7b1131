#include "studio/certificate.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include "base/test/temporary_folder.h"

namespace hvas::studio {
namespace {

constexpr std::int64_t kNowS = 1'800'000'000;  // 2027-01-15
constexpr std::int64_t kDayS = 86'400;

std::string Read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class CertificateTest : public ::testing::Test {
 protected:
  [[nodiscard]] Result<SelfSigned> Keep(const std::vector<std::string>& names,
                                        std::int64_t now_s = kNowS) const {
    return EnsureCertificate(tls_, names, now_s);
  }

  void Write(const std::string& text) const {
    std::filesystem::create_directories(tls_);
    std::ofstream(file_) << text;
    std::filesystem::permissions(file_, std::filesystem::perms(0600));
  }

  hvas::testing::TemporaryFolder folder_;
  const std::filesystem::path tls_{folder_.path() / "state" / "hvas"};
  const std::filesystem::path file_{tls_ / "studio.pem"};
};

struct X509End {
  void operator()(X509* certificate) const { X509_free(certificate); }
};

std::unique_ptr<X509, X509End> Parse(const std::filesystem::path& file) {
  BIO* bio = BIO_new_file(file.c_str(), "r");
  std::unique_ptr<X509, X509End> certificate(PEM_read_bio_X509(bio, nullptr, nullptr, nullptr));
  BIO_free(bio);
  return certificate;
}

TEST_F(CertificateTest, IsMadeOnceAndKept) {
  const auto first = Keep({"192.168.1.5", "workshop"});
  ASSERT_TRUE(first) << first.error().ToString();
  EXPECT_TRUE(first->is_new);
  const auto again = Keep({"192.168.1.5"}, kNowS + 300 * kDayS);
  ASSERT_TRUE(again) << again.error().ToString();
  EXPECT_FALSE(again->is_new);
  EXPECT_EQ(again->fingerprint, first->fingerprint);
}

TEST_F(CertificateTest, NobodyElseCanReadTheKey) {
  ASSERT_TRUE(Keep({"127.0.0.1"}));
  EXPECT_EQ(std::filesystem::status(file_).permissions(), std::filesystem::perms(0600));
  EXPECT_EQ(std::filesystem::status(tls_).permissions(), std::filesystem::perms(0700));
  ::chmod(file_.c_str(), 0640);
  const auto open = Keep({"127.0.0.1"});
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, ErrorCode::kInvalid);
  EXPECT_NE(open.error().remedy.find("chmod 600"), std::string::npos);
}

TEST_F(CertificateTest, IsForItsNamesAndForAYear) {
  ASSERT_TRUE(Keep({"192.168.1.5", "fd00::5", "workshop.local"}));
  const auto certificate = Parse(file_);
  ASSERT_NE(certificate, nullptr);
  EXPECT_EQ(X509_check_ip_asc(certificate.get(), "192.168.1.5", 0), 1);
  EXPECT_EQ(X509_check_ip_asc(certificate.get(), "fd00::5", 0), 1);
  EXPECT_EQ(X509_check_host(certificate.get(), "workshop.local", 0, 0, nullptr), 1);
  EXPECT_NE(X509_check_ip_asc(certificate.get(), "192.168.1.6", 0), 1);
  EXPECT_NE(X509_check_host(certificate.get(), "other.local", 0, 0, nullptr), 1);
  const auto is_valid_on = [&](std::int64_t day) {
    std::time_t time = kNowS + day * kDayS;
    return X509_cmp_time(X509_get0_notBefore(certificate.get()), &time) < 0 &&
           X509_cmp_time(X509_get0_notAfter(certificate.get()), &time) > 0;
  };
  EXPECT_TRUE(is_valid_on(0));
  EXPECT_TRUE(is_valid_on(365));
  EXPECT_FALSE(is_valid_on(398));  // longer ones are refused by browsers
  EXPECT_EQ(EVP_PKEY_bits(X509_get0_pubkey(certificate.get())), 256);
  EXPECT_EQ(EVP_PKEY_base_id(X509_get0_pubkey(certificate.get())), EVP_PKEY_EC);
  EXPECT_EQ(X509_verify(certificate.get(), X509_get0_pubkey(certificate.get())), 1);
  EXPECT_EQ(X509_check_ca(certificate.get()), 0);  // it signs for nobody
}

TEST_F(CertificateTest, IsMadeAnewBeforeItEndsAndForAnotherName) {
  const auto first = Keep({"192.168.1.5"});
  ASSERT_TRUE(first);
  const auto last_weeks = Keep({"192.168.1.5"}, kNowS + 390 * kDayS);
  ASSERT_TRUE(last_weeks);
  EXPECT_TRUE(last_weeks->is_new);
  EXPECT_NE(last_weeks->fingerprint, first->fingerprint);
  const auto moved = Keep({"192.168.1.6"}, kNowS + 391 * kDayS);
  ASSERT_TRUE(moved);
  EXPECT_TRUE(moved->is_new);
  EXPECT_EQ(CalcFingerprint(file_).value_or(""), moved->fingerprint);
  EXPECT_EQ(std::filesystem::status(file_).permissions(), std::filesystem::perms(0600));
}

TEST_F(CertificateTest, FingerprintIsTheDigestOfTheBytesBetweenTheLines) {
  ASSERT_TRUE(Keep({"127.0.0.1"}));
  const std::string pem = Read(file_);
  const std::string begin = "-----BEGIN CERTIFICATE-----\n";
  const std::size_t start = pem.find(begin) + begin.size();
  std::string base64 = pem.substr(start, pem.find("-----END CERT") - start);
  base64.erase(std::remove(base64.begin(), base64.end(), '\n'), base64.end());
  std::string der(base64.size(), '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(der.data()),
                                   reinterpret_cast<const unsigned char*>(base64.data()),
                                   static_cast<int>(base64.size()));
  const auto padding = std::count(base64.begin(), base64.end(), '=');
  std::array<unsigned char, 32> digest{};
  EVP_Digest(der.data(), static_cast<std::size_t>(size - padding), digest.data(), nullptr,
             EVP_sha256(), nullptr);
  std::string expected;
  for (const unsigned char byte : digest) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), "%s%02X", expected.empty() ? "" : ":", byte);
    expected += hex.data();
  }
  EXPECT_EQ(CalcFingerprint(file_).value_or(""), expected);
}

TEST_F(CertificateTest, FilesThatHoldSomethingElseAreErrorsThatSayWhatToDo) {
  ASSERT_TRUE(Keep({"127.0.0.1"}));
  const std::string good = Read(file_);
  const std::size_t middle = good.find("-----BEGIN CERTIFICATE");
  ASSERT_TRUE(EnsureCertificate(folder_ / "other", {"127.0.0.1"}, kNowS));
  const std::string other = Read(folder_ / "other" / "studio.pem");
  for (const std::string& text :
       {std::string(), std::string("nonsense"), good.substr(0, middle), good.substr(middle),
        good.substr(0, good.size() - 40), good.substr(0, middle) + other.substr(middle),
        std::string("-----BEGIN ENCRYPTED PRIVATE KEY-----\nAAAA\n"
                    "-----END ENCRYPTED PRIVATE KEY-----\n") +
            good.substr(middle)}) {
    Write(text);
    const auto kept = Keep({"127.0.0.1"});
    ASSERT_FALSE(kept) << text.substr(0, 40);
    EXPECT_EQ(kept.error().code, ErrorCode::kUnreadable);
    EXPECT_EQ(kept.error().where, file_.string());
    EXPECT_NE(kept.error().remedy.find("delete it"), std::string::npos);
  }
  EXPECT_FALSE(CalcFingerprint(folder_ / "missing.pem"));
}

TEST_F(CertificateTest, NamesThatAreNoneAreRefused) {
  for (const char* name :
       {"", "a b", "a,DNS:evil", "a\nb", "-a", ".a", "http://a", "a:8080", "*"}) {
    const auto kept = Keep({"127.0.0.1", name});
    ASSERT_FALSE(kept) << name;
    EXPECT_EQ(kept.error().code, ErrorCode::kInvalid);
  }
  EXPECT_FALSE(std::filesystem::exists(tls_));
}

TEST_F(CertificateTest, IsKeptWhereTheStateOfProgramsIs) {
  const auto with = [](const char* state, const char* home) {
    ::setenv("XDG_STATE_HOME", state, 1);
    ::setenv("HOME", home, 1);
    return FindCertificateFolder();
  };
  const std::string home_before = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
  EXPECT_EQ(with("/state", "/home/a").value_or(""), "/state/hvas");
  EXPECT_EQ(with("", "/home/a").value_or(""), "/home/a/.local/state/hvas");
  EXPECT_EQ(with("not/absolute", "/home/a").value_or(""), "/home/a/.local/state/hvas");
  EXPECT_FALSE(with("", ""));
  ::unsetenv("XDG_STATE_HOME");
  ::setenv("HOME", home_before.c_str(), 1);
}

TEST(NamesTest, AddressIsItsOwnNameAndAllOfThemAreThoseOfTheInterfaces) {
  EXPECT_EQ(ListNamesOf("192.168.1.5")->front(), "192.168.1.5");
  EXPECT_EQ(ListNamesOf("::1")->front(), "::1");
  for (const char* any : {"0.0.0.0", "::"}) {
    const auto names = ListNamesOf(any);
    ASSERT_TRUE(names);
    EXPECT_EQ(std::count(names->begin(), names->end(), any), 0);
    EXPECT_EQ(std::count(names->begin(), names->end(), "127.0.0.1"), 0);
    EXPECT_EQ(std::count(names->begin(), names->end(), "::1"), 0);
  }
  for (const char* wrong : {"", "localhost", "192.168.1", "192.168.1.5:80", "[::1]", "*"}) {
    EXPECT_FALSE(ListNamesOf(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace hvas::studio
