#include "studio/access.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace hvas::studio {
namespace {

constexpr std::uint16_t kPort = 8123;

std::string HeaderWith(const std::string& value) {
  return "hvas_session_" + std::to_string(kPort) + "=" + value;
}

/** What stands between '=' and the first ';' of a Set-Cookie. */
std::string SessionOf(const Access& access, Role role) {
  const std::string cookie = access.SetCookie(role);
  const std::size_t start = cookie.find('=') + 1;
  return cookie.substr(start, cookie.find(';') - start);
}

TEST(AccessTest, TokenHas32LettersOf64) {  // N11: 192 random bits
  constexpr std::size_t kLength = 32;
  std::set<char> seen;
  for (int i = 0; i < 200; ++i) {
    const std::string token = MakeToken();
    ASSERT_EQ(token.size(), kLength);
    seen.insert(token.begin(), token.end());
  }
  EXPECT_EQ(seen.size(), 64u);  // 6400 draws; the chance that a letter never came is 1e-42
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
           c == '_';
  }));
}

TEST(AccessTest, NoTwoTokensAreTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) {
    tokens.insert(MakeToken());
  }
  EXPECT_EQ(tokens.size(), 1000u);
}

TEST(AccessTest, SecretsAreComparedWhole) {
  EXPECT_TRUE(IsSameSecret("abc", "abc"));
  EXPECT_FALSE(IsSameSecret("abc", "abd"));
  EXPECT_FALSE(IsSameSecret("abc", "abcd"));
  EXPECT_FALSE(IsSameSecret("abcd", "abc"));
  EXPECT_FALSE(IsSameSecret("", "abc"));
  EXPECT_FALSE(IsSameSecret("ABC", "abc"));
  using namespace std::string_view_literals;
  EXPECT_FALSE(IsSameSecret("a\0b"sv, "a\0c"sv));
}

TEST(AccessTest, HostIsReadWithoutItsPort) {
  EXPECT_EQ(HostOf("127.0.0.1:8080"), "127.0.0.1");
  EXPECT_EQ(HostOf("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(HostOf("LocalHost:80"), "localhost");
  EXPECT_EQ(HostOf("[::1]:8080"), "::1");
  EXPECT_EQ(HostOf("[::1]"), "::1");
  EXPECT_EQ(HostOf("[FE80::A]"), "fe80::a");
}

TEST(AccessTest, HostThatIsNotWellFormedIsNone) {
  for (const char* host :
       {"", ":", ":80", "localhost:", "localhost:x", "localhost:80x", "localhost:123456",
        "localhost:-1", "::1", "[::1", "[::1]80", "[::1]:", "[::1]:x", "[]", "[]:80", "[localhost]",
        "a:80:80", "127.0.0.1:80@evil"}) {
    EXPECT_EQ(HostOf(host), std::nullopt) << host;
  }
}

TEST(AccessTest, CookieIsFoundByItsWholeName) {
  EXPECT_EQ(FindCookie("a=1; b=2; c=3", "b"), "2");
  EXPECT_EQ(FindCookie("a=1;b=2", "b"), "2");
  EXPECT_EQ(FindCookie("  b=2  ", "b"), "2");
  EXPECT_EQ(FindCookie("b=", "b"), "");
  EXPECT_EQ(FindCookie("b=x=y", "b"), "x=y");
  EXPECT_EQ(FindCookie("bb=1; xb=2", "b"), std::nullopt);
  EXPECT_EQ(FindCookie("B=1", "b"), std::nullopt);
  EXPECT_EQ(FindCookie("", "b"), std::nullopt);
  EXPECT_EQ(FindCookie(";;; ;", "b"), std::nullopt);
  EXPECT_EQ(FindCookie("b", "b"), std::nullopt);
  EXPECT_EQ(FindCookie("a=\"b=2\"", "b"), std::nullopt);
}

TEST(AccessTest, AnswersToTheLoopbacksNamesOnly) {
  const Access access({}, kPort, false);
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:8123", "localhost:8123", "LOCALHOST:8123", "[::1]:8123"}) {
    EXPECT_TRUE(access.AllowsHost(host)) << host;
  }
}

TEST(AccessTest, NamesThatADnsServerMayPointHereAreRefused) {  // N11: DNS rebinding
  const Access access({}, kPort, false);
  for (const char* host : {"",
                           "evil.example",
                           "evil.example:8123",
                           "127.0.0.1.evil.example",
                           "localhost.evil",
                           "localhost.evil:8123",
                           "evil.localhost",
                           "127.0.0.1@evil",
                           "evil@127.0.0.1",
                           "127.0.0.1:8123@evil",
                           "localhost.",
                           "127.0.0.1.",
                           " 127.0.0.1",
                           "127.0.0.1 ",
                           "127.0.0.2",
                           "127.1",
                           "2130706433",
                           "0x7f000001",
                           "0.0.0.0",
                           "[::]",
                           "[::ffff:127.0.0.1]",
                           "::1",
                           "localhost,evil",
                           "localhost evil",
                           "localhost/",
                           "localhost#",
                           "localhost\\evil",
                           "xlocalhost"}) {
    EXPECT_FALSE(access.AllowsHost(host)) << host;
  }
  using namespace std::string_view_literals;
  EXPECT_FALSE(access.AllowsHost("localhost\0.evil"sv));
}

TEST(AccessTest, FurtherNamesAreThoseGiven) {
  const Access access({"Studio.Example"}, kPort, false);
  EXPECT_TRUE(access.AllowsHost("studio.example:8123"));
  EXPECT_TRUE(access.AllowsOrigin("http://studio.example:8123"));
  EXPECT_FALSE(access.AllowsHost("example:8123"));
  EXPECT_FALSE(access.AllowsHost("a.studio.example:8123"));
  EXPECT_FALSE(access.AllowsOrigin("http://a.studio.example:8123"));
}

TEST(AccessTest, OwnOriginsAreAllowed) {
  const Access access({}, kPort, false);
  EXPECT_TRUE(access.AllowsOrigin("http://127.0.0.1:8123"));
  EXPECT_TRUE(access.AllowsOrigin("http://localhost:8123"));
  EXPECT_TRUE(access.AllowsOrigin("http://[::1]:8123"));
}

TEST(AccessTest, OriginsAreComparedAsAWhole) {  // N11: neither prefix nor pattern
  const Access access({}, kPort, false);
  for (const char* origin : {"",
                             "null",
                             "http://127.0.0.1",
                             "http://127.0.0.1:8124",
                             "http://127.0.0.1:81230",
                             "http://127.0.0.1:812",
                             "https://127.0.0.1:8123",
                             "ws://127.0.0.1:8123",
                             "http://127.0.0.1:8123.evil.example",
                             "http://127.0.0.1:8123@evil.example",
                             "http://evil.example/http://127.0.0.1:8123",
                             "http://evil.example?http://127.0.0.1:8123",
                             "xhttp://127.0.0.1:8123",
                             "http://127.0.0.1:8123/",
                             "http://127.0.0.1:8123 ",
                             " http://127.0.0.1:8123",
                             "http://localhost.evil:8123",
                             "http://evil-localhost:8123",
                             "http://127a0b0c1:8123",
                             "file://",
                             "127.0.0.1:8123",
                             "HTTP://127.0.0.1:8123",
                             "http://127.0.0.1:8123, http://evil.example"}) {
    EXPECT_FALSE(access.AllowsOrigin(origin)) << origin;
  }
}

TEST(AccessTest, PagesComeByTheSchemeThatIsServed) {
  const Access access({}, kPort, true);
  EXPECT_TRUE(access.AllowsOrigin("https://127.0.0.1:8123"));
  EXPECT_FALSE(access.AllowsOrigin("http://127.0.0.1:8123"));
}

TEST(AccessTest, OriginAtTheSchemesOwnPortHasNone) {  // as browsers write it
  EXPECT_TRUE(Access({}, 80, false).AllowsOrigin("http://localhost"));
  EXPECT_TRUE(Access({}, 443, true).AllowsOrigin("https://localhost"));
  EXPECT_FALSE(Access({}, 443, false).AllowsOrigin("http://localhost"));
  EXPECT_FALSE(Access({}, 80, true).AllowsOrigin("https://localhost"));
}

TEST(AccessTest, TokenGivesItsRole) {
  const Access access({}, kPort, false);
  EXPECT_NE(access.token(Role::kOperator), access.token(Role::kViewer));
  EXPECT_EQ(access.RoleOfToken(access.token(Role::kOperator)), Role::kOperator);
  EXPECT_EQ(access.RoleOfToken(access.token(Role::kViewer)), Role::kViewer);
  EXPECT_EQ(access.RoleOfToken(""), std::nullopt);
  EXPECT_EQ(access.RoleOfToken(access.token(Role::kOperator).substr(1)), std::nullopt);
  EXPECT_EQ(access.RoleOfToken(access.token(Role::kOperator) + "A"), std::nullopt);
  EXPECT_EQ(access.RoleOfToken(MakeToken()), std::nullopt);
}

TEST(AccessTest, CookieGivesItsRole) {
  const Access access({}, kPort, false);
  for (const Role role : {Role::kOperator, Role::kViewer}) {
    const std::string session = SessionOf(access, role);
    EXPECT_EQ(access.RoleOfCookie(HeaderWith(session)), role);
    EXPECT_EQ(access.RoleOfCookie("theme=dark; " + HeaderWith(session) + "; x=y"), role);
    EXPECT_EQ(access.RoleOfCookie("x" + HeaderWith(session)), std::nullopt);
    EXPECT_EQ(access.RoleOfCookie(HeaderWith(session + "A")), std::nullopt);
    EXPECT_EQ(access.RoleOfCookie(session), std::nullopt);
  }
  EXPECT_EQ(access.RoleOfCookie(""), std::nullopt);
  EXPECT_EQ(access.RoleOfCookie(HeaderWith("")), std::nullopt);
}

TEST(AccessTest, TokenIsNoSession) {  // a link that was looked over a shoulder once is not a cookie
  const Access access({}, kPort, false);
  for (const Role role : {Role::kOperator, Role::kViewer}) {
    EXPECT_EQ(access.RoleOfCookie(HeaderWith(access.token(role))), std::nullopt);
    EXPECT_EQ(access.RoleOfToken(SessionOf(access, role)), std::nullopt);
  }
}

TEST(AccessTest, SecretsOfOneServerAreNoneOfAnother) {
  const Access one({}, kPort, false);
  const Access other({}, kPort, false);
  EXPECT_EQ(other.RoleOfToken(one.token(Role::kOperator)), std::nullopt);
  EXPECT_EQ(other.RoleOfCookie(HeaderWith(SessionOf(one, Role::kOperator))), std::nullopt);
}

TEST(AccessTest, CookiesOfTwoServersOnOneHostDoNotMeet) {  // browsers tell no ports apart
  const Access one({}, kPort, false);
  const Access other({}, kPort + 1, false);
  EXPECT_NE(one.cookie_name(), other.cookie_name());
  const auto pair_of = [](const Access& access, Role role) {
    const std::string cookie = access.SetCookie(role);
    return cookie.substr(0, cookie.find(';'));
  };
  const std::string both = pair_of(one, Role::kOperator) + "; " + pair_of(other, Role::kViewer);
  EXPECT_EQ(one.RoleOfCookie(both), Role::kOperator);
  EXPECT_EQ(other.RoleOfCookie(both), Role::kViewer);
}

TEST(AccessTest, CookieIsOutOfReachOfScriptsAndOtherSites) {
  const std::string plain = Access({}, kPort, false).SetCookie(Role::kOperator);
  EXPECT_NE(plain.find("; HttpOnly"), std::string::npos);
  EXPECT_NE(plain.find("; SameSite=Strict"), std::string::npos);
  EXPECT_NE(plain.find("; Path=/"), std::string::npos);
  EXPECT_EQ(plain.find("Domain"), std::string::npos);
  EXPECT_EQ(plain.find("; Secure"), std::string::npos);
  EXPECT_NE(Access({}, kPort, true).SetCookie(Role::kOperator).find("; Secure"), std::string::npos);
}

}  // namespace
}  // namespace hvas::studio
