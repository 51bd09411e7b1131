#include "studio/access.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/test/temporary_folder.h"

namespace hvas::studio {
namespace {

constexpr std::uint16_t kPort = 8123;

std::string HeaderWith(const std::string& value) {
  return "hvas_session_" + std::to_string(kPort) + "=" + value;
}

/** What a browser sends as its cookie after this Set-Cookie. */
std::string CookieIn(const std::string& set_cookie) {
  return set_cookie.substr(0, set_cookie.find(';'));
}

/** The Cookie header of a browser that has come by a link. */
std::string ComeBy(Access* access, const std::string& token, const std::string& cookie = "") {
  const auto admission = access->Admit(token, cookie);
  EXPECT_TRUE(admission.has_value());
  return admission ? CookieIn(admission->set_cookie) : "";
}

/** Role of the browser with a Cookie header; none: it has no session. */
std::optional<Role> RoleOf(const Access& access, const std::string& cookie_header) {
  const auto visitor = access.FindVisitor(cookie_header);
  return visitor ? std::optional(visitor->role) : std::nullopt;
}

std::string ValueOf(const std::string& header) {
  return header.substr(header.find('=') + 1);
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
  EXPECT_EQ(FindHost("127.0.0.1:8080"), "127.0.0.1");
  EXPECT_EQ(FindHost("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(FindHost("LocalHost:80"), "localhost");
  EXPECT_EQ(FindHost("[::1]:8080"), "::1");
  EXPECT_EQ(FindHost("[::1]"), "::1");
  EXPECT_EQ(FindHost("[FE80::A]"), "fe80::a");
}

TEST(AccessTest, HostThatIsNotWellFormedIsNone) {
  for (const char* host :
       {"", ":", ":80", "localhost:", "localhost:x", "localhost:80x", "localhost:123456",
        "localhost:-1", "::1", "[::1", "[::1]80", "[::1]:", "[::1]:x", "[]", "[]:80", "[localhost]",
        "a:80:80", "127.0.0.1:80@evil"}) {
    EXPECT_EQ(FindHost(host), std::nullopt) << host;
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
  for (const Role role : kRoles) {
    Access access({}, kPort, false);
    EXPECT_EQ(access.Admit(access.token(role), "")->visitor.role, role);
    for (const std::string& wrong :
         {std::string(), access.token(role).substr(1), access.token(role) + "A", MakeToken()}) {
      EXPECT_EQ(access.Admit(wrong, "").error().code, ErrorCode::kNotFound) << wrong;
    }
  }
  const Access access({}, kPort, false);
  EXPECT_NE(access.token(Role::kOperator), access.token(Role::kViewer));
}

TEST(AccessTest, LinkToSteerLetsOneBrowserIn) {
  for (const Role role : {Role::kOperator, Role::kParticipant}) {
    Access access({}, kPort, false);
    const std::string token = access.token(role);
    const std::string first = ComeBy(&access, token);
    const std::string viewer = ComeBy(&access, access.token(Role::kViewer));
    for (const std::string& other : {std::string(), viewer, HeaderWith(MakeToken())}) {
      const auto again = access.Admit(token, other);
      ASSERT_FALSE(again.has_value()) << other;
      EXPECT_EQ(again.error().code, ErrorCode::kInvalid);
      EXPECT_NE(again.error().remedy, "");
    }
    EXPECT_EQ(access.Admit(token, first)->visitor.role, role) << "the same browser comes again";
    EXPECT_EQ(ComeBy(&access, token, first), first);
  }
}

TEST(AccessTest, LinkToLookOnIsForWhoeverHasIt) {
  Access access({}, kPort, false);
  const std::string one = ComeBy(&access, access.token(Role::kViewer));
  const std::string other = ComeBy(&access, access.token(Role::kViewer));
  EXPECT_NE(one, other);
  EXPECT_EQ(RoleOf(access, one), Role::kViewer);
  EXPECT_EQ(RoleOf(access, other), Role::kViewer);
  EXPECT_EQ(access.MakeInvitation(Role::kViewer), access.token(Role::kViewer));
}

TEST(AccessTest, EachInvitationLetsOneMoreBrowserIn) {
  Access access({}, kPort, false);
  const std::string first = access.MakeInvitation(Role::kOperator);
  const std::string second = access.MakeInvitation(Role::kOperator);
  EXPECT_NE(first, second);
  EXPECT_EQ(RoleOf(access, ComeBy(&access, first)), Role::kOperator);
  EXPECT_FALSE(access.Admit(first, "").has_value());
  EXPECT_EQ(RoleOf(access, ComeBy(&access, second)), Role::kOperator);
}

TEST(AccessTest, WhoOpenedTheStudioEndsTheSharing) {
  Access access({}, kPort, false);
  const std::string host = ComeBy(&access, access.token(Role::kOperator));
  const std::string invitation = access.MakeInvitation(Role::kOperator);
  const std::string guest = ComeBy(&access, invitation);
  const std::string unused = access.MakeInvitation(Role::kOperator);
  const std::string viewers = access.token(Role::kViewer);
  const std::string viewer = ComeBy(&access, viewers);
  for (const std::string& other : {guest, viewer, std::string(), std::string("x=y")}) {
    EXPECT_FALSE(access.EndSharing(other)) << other;
    EXPECT_EQ(RoleOf(access, guest), Role::kOperator);
  }
  EXPECT_TRUE(access.EndSharing(host));
  EXPECT_EQ(RoleOf(access, host), Role::kOperator);
  EXPECT_FALSE(access.FindVisitor(guest));
  EXPECT_FALSE(access.FindVisitor(viewer));
  for (const std::string& old : {invitation, unused, viewers}) {
    EXPECT_FALSE(access.Admit(old, "")) << "the link is void";
  }
  EXPECT_TRUE(access.Admit(access.token(Role::kViewer), "")) << "a new one can be passed on";
}

TEST(AccessTest, FreshLinkIsAnotherOneOnceSomebodyHasComeByIt) {
  Access access({}, kPort, false);
  const std::string fresh = access.FindUnusedLink(Role::kParticipant);
  EXPECT_EQ(access.FindUnusedLink(Role::kParticipant), fresh);
  ComeBy(&access, fresh);
  EXPECT_NE(access.FindUnusedLink(Role::kParticipant), fresh);
}

TEST(AccessTest, ViewersLinkTakesNothingFromWhoHasComeByAnotherOne) {
  Access access({}, kPort, false);
  const std::string token = access.token(Role::kOperator);
  const std::string owner = ComeBy(&access, token);
  const std::string guest = ComeBy(&access, access.MakeInvitation(Role::kOperator));
  for (const std::string& cookie : {owner, guest}) {
    EXPECT_EQ(ComeBy(&access, access.token(Role::kViewer), cookie), cookie);
    EXPECT_EQ(RoleOf(access, cookie), Role::kOperator);
  }
  EXPECT_TRUE(access.FindVisitor(owner)->is_owner);
  for (std::size_t i = 0; i < 2 * Access::kMaxViewers; ++i) {
    ComeBy(&access, access.token(Role::kViewer));
  }
  EXPECT_EQ(RoleOf(access, owner), Role::kOperator) << "no viewer takes its place";
  EXPECT_EQ(RoleOf(access, guest), Role::kOperator);
  // Who looks on and is invited then works.
  const std::string viewer = ComeBy(&access, access.token(Role::kViewer));
  ComeBy(&access, access.MakeInvitation(Role::kOperator), viewer);
  EXPECT_EQ(RoleOf(access, viewer), Role::kOperator);
}

TEST(AccessTest, WhoComesAgainChangesNothing) {
  Access access({}, kPort, false);
  for (const Role role : kRoles) {
    const std::string cookie = ComeBy(&access, access.token(role));
    EXPECT_FALSE(access.Admit(access.token(role), cookie)->has_changed);
  }
  EXPECT_TRUE(access.Admit(access.token(Role::kViewer), "")->has_changed);
}

TEST(AccessTest, OwnerIsTheBrowserOfTheFirstOperatorsLink) {
  Access access({}, kPort, false);
  const std::string owner = ComeBy(&access, access.token(Role::kOperator));
  const std::string guest = ComeBy(&access, access.MakeInvitation(Role::kOperator));
  const std::string viewer = ComeBy(&access, access.token(Role::kViewer));
  EXPECT_TRUE(access.FindVisitor(owner)->is_owner);
  EXPECT_STREQ(ToString(*access.FindVisitor(owner)), "owner");
  EXPECT_FALSE(access.FindVisitor(guest)->is_owner);
  EXPECT_STREQ(ToString(*access.FindVisitor(guest)), "operator");
  EXPECT_FALSE(access.FindVisitor(viewer)->is_owner);
  Access after({}, kPort, false, access.Keep());
  EXPECT_TRUE(after.FindVisitor(owner)->is_owner) << "also after the next start";
  EXPECT_FALSE(after.FindVisitor(guest)->is_owner);
}

TEST(AccessTest, QuotasAreSharedByAllViewersAndByNobodyElse) {
  Access access({}, kPort, false);
  const auto link_of = [&access](const std::string& token) {
    return access.FindVisitor(ComeBy(&access, token))->link();
  };
  const std::uint32_t viewers = link_of(access.token(Role::kViewer));
  EXPECT_EQ(link_of(access.token(Role::kViewer)), viewers);
  const std::set<std::uint32_t> all{viewers, link_of(access.token(Role::kOperator)),
                                    link_of(access.token(Role::kParticipant)),
                                    link_of(access.MakeInvitation(Role::kOperator))};
  EXPECT_EQ(all.size(), 4u);
}

TEST(AccessTest, ManyWhoLookOnDriveNobodyElseOut) {
  Access access({}, kPort, false);
  const std::string steers = ComeBy(&access, access.token(Role::kOperator));
  const std::string guest = ComeBy(&access, access.MakeInvitation(Role::kOperator));
  ::testing::internal::CaptureStderr();
  for (std::size_t i = 0; i < 3 * Access::kMaxLinks; ++i) {
    ComeBy(&access, access.token(Role::kViewer));
    (void)access.MakeInvitation(Role::kOperator);
  }
  const std::string warnings = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(warnings.find("the oldest of 64 links"), std::string::npos) << warnings;
  EXPECT_EQ(RoleOf(access, steers), Role::kOperator);
  EXPECT_EQ(RoleOf(access, guest), Role::kOperator);
  EXPECT_EQ(ComeBy(&access, access.token(Role::kOperator), steers), steers);
  EXPECT_LE(access.Keep().browsers.size(), Access::kMaxViewers + 2);
  EXPECT_LE(access.Keep().links.size(), Access::kMaxLinks);
}

TEST(AccessTest, CookieGivesItsRole) {
  for (const Role role : kRoles) {
    Access access({}, kPort, false);
    const std::string session = ValueOf(ComeBy(&access, access.token(role)));
    EXPECT_EQ(RoleOf(access, HeaderWith(session)), role);
    EXPECT_EQ(RoleOf(access, "theme=dark; " + HeaderWith(session) + "; x=y"), role);
    EXPECT_EQ(RoleOf(access, "x" + HeaderWith(session)), std::nullopt);
    EXPECT_EQ(RoleOf(access, HeaderWith(session + "A")), std::nullopt);
    EXPECT_EQ(RoleOf(access, session), std::nullopt);
    EXPECT_EQ(RoleOf(access, ""), std::nullopt);
    EXPECT_EQ(RoleOf(access, HeaderWith("")), std::nullopt);
  }
}

TEST(AccessTest, TokenIsNoSession) {  // a link that was looked over a shoulder once is not a cookie
  Access access({}, kPort, false);
  for (const Role role : {Role::kOperator, Role::kViewer}) {
    EXPECT_EQ(RoleOf(access, HeaderWith(access.token(role))), std::nullopt);
    const std::string session = ValueOf(ComeBy(&access, access.token(role)));
    EXPECT_FALSE(access.Admit(session, "").has_value());
  }
}

TEST(AccessTest, SecretsOfOneServerAreNoneOfAnother) {
  Access one({}, kPort, false);
  Access other({}, kPort, false);
  EXPECT_FALSE(other.Admit(one.token(Role::kOperator), "").has_value());
  EXPECT_EQ(RoleOf(other, ComeBy(&one, one.token(Role::kOperator))), std::nullopt);
}

TEST(AccessTest, CookiesOfTwoServersOnOneHostDoNotMeet) {  // browsers tell no ports apart
  Access one({}, kPort, false);
  Access other({}, kPort + 1, false);
  EXPECT_NE(one.cookie_name(), other.cookie_name());
  const std::string both =
      ComeBy(&one, one.token(Role::kOperator)) + "; " + ComeBy(&other, other.token(Role::kViewer));
  EXPECT_EQ(RoleOf(one, both), Role::kOperator);
  EXPECT_EQ(RoleOf(other, both), Role::kViewer);
}

TEST(AccessTest, CookieIsOutOfReachOfScriptsAndOtherSites) {
  Access access({}, kPort, false);
  const std::string plain = access.Admit(access.token(Role::kOperator), "")->set_cookie;
  EXPECT_NE(plain.find("; HttpOnly"), std::string::npos);
  EXPECT_NE(plain.find("; SameSite=Strict"), std::string::npos);
  EXPECT_NE(plain.find("; Path=/"), std::string::npos);
  EXPECT_EQ(plain.find("Domain"), std::string::npos);
  EXPECT_EQ(plain.find("; Secure"), std::string::npos);
  Access safe({}, kPort, true);
  EXPECT_NE(safe.Admit(safe.token(Role::kOperator), "")->set_cookie.find("; Secure"),
            std::string::npos);
}

class KeptAccessTest : public ::testing::Test {
 protected:
  hvas::testing::TemporaryFolder folder_;
  const std::filesystem::path file_{folder_ / "access.json"};
};

TEST_F(KeptAccessTest, NextStartKnowsLinksAndBrowsersOfTheOneBefore) {
  Access before({}, kPort, false);
  const std::string steers = ComeBy(&before, before.token(Role::kOperator));
  const std::string looks_on = ComeBy(&before, before.token(Role::kViewer));
  const std::string unused = before.MakeInvitation(Role::kOperator);
  ASSERT_TRUE(SaveAccess(file_, before.Keep()));

  const auto kept = LoadAccess(file_);
  ASSERT_TRUE(kept.has_value()) << kept.error().ToString();
  Access after({}, kPort, false, *kept);
  EXPECT_EQ(after.token(Role::kOperator), before.token(Role::kOperator));
  EXPECT_EQ(RoleOf(after, steers), Role::kOperator);
  EXPECT_EQ(RoleOf(after, looks_on), Role::kViewer);
  EXPECT_EQ(ComeBy(&after, after.token(Role::kOperator), steers), steers);
  EXPECT_FALSE(after.Admit(after.token(Role::kOperator), "").has_value());
  EXPECT_EQ(RoleOf(after, ComeBy(&after, unused)), Role::kOperator);
}

TEST_F(KeptAccessTest, CountsAtItsOwnPortOnly) {
  Access before({}, kPort, false);
  Access after({}, kPort + 1, false, before.Keep());
  EXPECT_NE(after.token(Role::kOperator), before.token(Role::kOperator));
  EXPECT_EQ(after.Keep().port, kPort + 1);
}

TEST_F(KeptAccessTest, FileIsNobodyElses) {
  const Access access({}, kPort, false);
  ASSERT_TRUE(SaveAccess(file_, access.Keep()));
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(file_).permissions(), perms::owner_read | perms::owner_write);
  std::filesystem::permissions(file_, perms::group_read, std::filesystem::perm_options::add);
  EXPECT_EQ(LoadAccess(file_).error().code, ErrorCode::kInvalid);
}

TEST_F(KeptAccessTest, DamagedFilesAreRefused) {
  Access access({}, kPort, false);
  ComeBy(&access, access.token(Role::kOperator));
  ASSERT_TRUE(SaveAccess(file_, access.Keep()));
  const nlohmann::json good = nlohmann::json::parse(std::ifstream(file_));
  const auto with = [&good](const char* pointer, const nlohmann::json& value) {
    nlohmann::json bad = good;
    bad[nlohmann::json::json_pointer(pointer)] = value;
    return bad;
  };
  for (const nlohmann::json& bad :
       {nlohmann::json(), nlohmann::json::array(), nlohmann::json::object(), with("/version", 2),
        with("/port", 65536), with("/port", -1), with("/port", 1e300), with("/links", 5),
        with("/links", nlohmann::json::array()), with("/links/0/token", "short"),
        with("/links/0/token", 5), with("/links/0/role", "viewer"), with("/links/0/role", "king"),
        with("/links/0/browser", "x"), with("/browsers", {{"secret", 5}}),
        with("/browsers/0/secret", ""), with("/browsers/0/role", nlohmann::json())}) {
    std::ofstream(file_) << bad.dump();
    const auto read = LoadAccess(file_);
    ASSERT_FALSE(read.has_value()) << bad;
    EXPECT_EQ(read.error().code, ErrorCode::kUnreadable) << bad;
  }
  std::filesystem::remove(file_);
  EXPECT_EQ(LoadAccess(file_).error().code, ErrorCode::kNotFound);
  std::filesystem::create_directory(file_);
  EXPECT_EQ(LoadAccess(file_).error().code, ErrorCode::kInvalid);
}

}  // namespace
}  // namespace hvas::studio
