#include "studio/access.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>

#include "base/atomic_file.h"
#include "base/parse_json.h"
#include "studio/json_fields.h"
#include "studio/state_folder.h"

namespace hvas::studio {
namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

constexpr std::size_t kTokenLength = 32;       // Letters of an alphabet of 64: 192 bits.
constexpr std::uint32_t kAccessVersion = 1;    // The file's format.
constexpr std::uint32_t kHighestPort = 65535;  // The largest number of 16 bits.

bool IsToken(std::string_view text) {
  return text.size() == kTokenLength && text.find_first_not_of(kAlphabet) == std::string_view::npos;
}

bool HasArray(const Json& object, const char* name) {
  return object.is_object() && object.contains(name) && object[name].is_array();
}

bool IsPort(std::string_view text) {
  constexpr std::size_t kMaxDigits = 5;  // Digits of 65535.
  return !text.empty() && text.size() <= kMaxDigits &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string ToLower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) {
    text.remove_prefix(1);
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) {
    text.remove_suffix(1);
  }
  return text;
}

}  // namespace

const char* ToString(Role role) {
  switch (role) {
    case Role::kOperator:
      return "operator";
    case Role::kParticipant:
      return "participant";
    case Role::kViewer:
      break;
  }
  return "viewer";
}

const char* ToString(const Visitor& visitor) {
  return visitor.is_owner ? "owner" : ToString(visitor.role);
}

std::optional<Role> ParseRole(std::string_view name) {
  const auto found = std::find_if(kRoles.begin(), kRoles.end(),
                                  [name](Role role) { return name == ToString(role); });
  return found != kRoles.end() ? std::optional(*found) : std::nullopt;
}

std::string MakeToken() {
  std::array<unsigned char, kTokenLength> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    throw std::runtime_error("the system provides no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kAlphabet[byte % kAlphabet.size()];  // 64 characters divide 256: uniform
  }
  return token;
}

bool IsSameSecret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::optional<std::string> FindHost(std::string_view host_header) {
  std::string_view host = host_header;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) {
      return std::nullopt;
    }
    const std::string_view rest = host.substr(end + 1);
    if (!rest.empty() && !(rest.front() == ':' && IsPort(rest.substr(1)))) {
      return std::nullopt;
    }
    const std::string_view address = host.substr(1, end - 1);
    return address.find(':') != std::string_view::npos ? std::optional(ToLower(address))
                                                       : std::nullopt;
  }
  if (const std::size_t colon = host.find(':'); colon != std::string_view::npos) {
    if (!IsPort(host.substr(colon + 1))) {
      return std::nullopt;
    }
    host = host.substr(0, colon);
  }
  return host.empty() ? std::nullopt : std::optional(ToLower(host));
}

std::optional<std::string> FindCookie(std::string_view cookie_header, std::string_view name) {
  while (!cookie_header.empty()) {
    const std::size_t end = cookie_header.find(';');
    const std::string_view pair = Trim(cookie_header.substr(0, end));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name) {
      return std::string(pair.substr(equals + 1));
    }
    cookie_header = end == std::string_view::npos ? "" : cookie_header.substr(end + 1);
  }
  return std::nullopt;
}

Access::Access(const std::vector<std::string>& names, std::uint16_t port, bool is_tls,
               SavedAccess kept)
    : hosts_{"127.0.0.1", "localhost", "::1"},
      cookie_name_(fmt::format("hvas_session_{}", port)),
      port_(port),
      is_tls_(is_tls) {
  for (const std::string& name : names) {
    hosts_.push_back(ToLower(name));
  }
  for (const std::string& host : hosts_) {
    origins_.push_back(OriginOf(host));
  }
  if (kept.port == port && kept.links.size() >= kRoles.size()) {
    known_ = std::move(kept);
    for (SavedAccess::Browser& browser : known_.browsers) {
      browser.number = ++last_browser_;
    }
    return;
  }
  known_.port = port;
  for (const Role role : kRoles) {
    AddLink(role);
  }
}

std::string Access::OriginOf(std::string_view host) const {
  // The ports of the schemes.
  constexpr std::uint16_t kHttp = 80;
  constexpr std::uint16_t kHttps = 443;
  // Browsers omit the default port of the scheme.
  const std::string suffix =
      port_ == (is_tls_ ? kHttps : kHttp) ? std::string() : fmt::format(":{}", port_);
  const bool is_v6 = host.find(':') != std::string_view::npos;
  return fmt::format("{}://{}{}{}{}", is_tls_ ? "https" : "http", is_v6 ? "[" : "", host,
                     is_v6 ? "]" : "", suffix);
}

bool Access::AllowsHost(std::string_view host_header) const {
  const std::optional<std::string> host = FindHost(host_header);
  return host && std::find(hosts_.begin(), hosts_.end(), *host) != hosts_.end();
}

bool Access::AllowsOrigin(std::string_view origin) const {
  return std::find(origins_.begin(), origins_.end(), origin) != origins_.end();
}

SavedAccess::Browser* Access::FindBrowser(std::string_view secret) {
  // All entries are compared each time, so that the time does not tell which one matched.
  SavedAccess::Browser* found = nullptr;
  for (SavedAccess::Browser& browser : known_.browsers) {
    found = IsSameSecret(secret, browser.secret) ? &browser : found;
  }
  return found;
}

std::string Access::AddLink(Role role) {
  auto& links = known_.links;
  if (links.size() >= kMaxLinks) {
    links.erase(links.begin() + kRoles.size());
    fmt::print(stderr, "warning: the oldest of {} links lets nobody in any more\n", kMaxLinks);
  }
  links.push_back({MakeToken(), role, ""});
  return links.back().token;
}

SavedAccess::Browser* Access::AddBrowser(Role role) {
  auto& browsers = known_.browsers;
  const auto is_viewer = [](const SavedAccess::Browser& one) { return one.role == Role::kViewer; };
  if (role == Role::kViewer) {
    const auto viewers = std::count_if(browsers.begin(), browsers.end(), is_viewer);
    if (static_cast<std::size_t>(viewers) >= kMaxViewers) {
      browsers.erase(std::find_if(browsers.begin(), browsers.end(), is_viewer));
    }
  }
  browsers.push_back({MakeToken(), role, ++last_browser_});
  return &browsers.back();
}

Visitor Access::MakeVisitor(const SavedAccess::Browser& browser) const {
  const SavedAccess::Link& own = known_.links[static_cast<std::size_t>(Role::kOperator)];
  const bool is_owner = !own.browser.empty() && IsSameSecret(own.browser, browser.secret);
  return {browser.role, is_owner, browser.number};
}

Result<Access::Admission> Access::Admit(std::string_view token, std::string_view cookie_header) {
  const std::lock_guard lock(mutex_);
  SavedAccess::Link* link = nullptr;
  for (SavedAccess::Link& one : known_.links) {
    link = IsSameSecret(token, one.token) ? &one : link;
  }
  if (link == nullptr) {
    return Fail(ErrorCode::kNotFound, "this link is not valid", "",
                "open the link that the program has printed, or ask the user in control for one");
  }
  SavedAccess::Browser* browser = FindBrowser(FindCookie(cookie_header, cookie_name_).value_or(""));
  const bool is_its_own = browser != nullptr && IsSameSecret(link->browser, browser->secret);
  if (IsSingleUse(link->role) && !link->browser.empty() && !is_its_own) {
    return Fail(ErrorCode::kInvalid, "this link has been used by another browser already", "",
                "ask the user in control for a link of your own (\"Share\"), or start the studio "
                "again with --new-links");
  }
  bool has_changed = browser == nullptr;
  if (browser == nullptr) {
    browser = AddBrowser(link->role);
  } else if (browser->role != link->role && IsSingleUse(link->role) &&
             !MakeVisitor(*browser).is_owner) {
    browser->role = link->role;  // A viewers' link takes nothing from who has come by another one.
    has_changed = true;
  }
  if (IsSingleUse(link->role) && link->browser != browser->secret) {
    link->browser = browser->secret;
    has_changed = true;
  }
  constexpr int kCookieLifetime = 30 * 24 * 3600;  // [s], 30 days: a choice.
  return Admission{
      MakeVisitor(*browser), has_changed,
      fmt::format("{}={}; Path=/; Max-Age={}; HttpOnly; SameSite=Strict{}", cookie_name_,
                  browser->secret, kCookieLifetime, is_tls_ ? "; Secure" : "")};
}

bool Access::EndSharing(std::string_view cookie_header) {
  const std::string secret = FindCookie(cookie_header, cookie_name_).value_or("");
  const std::lock_guard lock(mutex_);
  const SavedAccess::Link& own = known_.links[static_cast<std::size_t>(Role::kOperator)];
  if (own.browser.empty() || !IsSameSecret(own.browser, secret)) {
    return false;
  }
  std::erase_if(known_.browsers, [&secret](const SavedAccess::Browser& browser) {
    return !IsSameSecret(browser.secret, secret);
  });
  known_.links.resize(kRoles.size());
  for (const Role role : kRoles) {
    if (role != Role::kOperator) {
      known_.links[static_cast<std::size_t>(role)] = {MakeToken(), role, ""};
    }
  }
  return true;
}

std::optional<Visitor> Access::FindVisitor(std::string_view cookie_header) const {
  const std::string secret = FindCookie(cookie_header, cookie_name_).value_or("");
  const std::lock_guard lock(mutex_);
  // All entries are compared each time, so that the time does not tell which one matched.
  std::optional<Visitor> visitor;
  for (const SavedAccess::Browser& browser : known_.browsers) {
    visitor = IsSameSecret(secret, browser.secret) ? std::optional(MakeVisitor(browser)) : visitor;
  }
  return visitor;
}

std::string Access::token(Role role) const {
  const std::lock_guard lock(mutex_);
  return known_.links[static_cast<std::size_t>(role)].token;
}

std::string Access::MakeInvitation(Role role) {
  if (!IsSingleUse(role)) {
    return token(role);
  }
  const std::lock_guard lock(mutex_);
  return AddLink(role);
}

std::string Access::FindUnusedLink(Role role) {
  const std::lock_guard lock(mutex_);
  const auto fresh =
      std::find_if(known_.links.begin(), known_.links.end(),
                   [role](const auto& link) { return link.role == role && link.browser.empty(); });
  return fresh != known_.links.end() ? fresh->token : AddLink(role);
}

SavedAccess Access::Keep() const {
  const std::lock_guard lock(mutex_);
  return known_;
}

Result<SavedAccess> LoadAccess(const std::filesystem::path& file) {
  const auto text = ReadPrivateFile(file);
  if (!text) {
    return Unexpected(text.error());
  }
  const Json json = ParseJson<Json>(*text);
  const auto unreadable = [&file] {
    return Fail(ErrorCode::kUnreadable, "the file does not contain the studio's links",
                file.string(), "delete the file; the studio makes new links");
  };
  const std::uint32_t port = IndexOr(json, "port", kHighestPort + 1);
  if (IndexOr(json, "version", 0) != kAccessVersion || port > kHighestPort ||
      !HasArray(json, "links") || !HasArray(json, "browsers")) {
    return unreadable();
  }
  SavedAccess kept;
  kept.port = static_cast<std::uint16_t>(port);
  for (const Json& browser : json["browsers"]) {
    const auto role = ParseRole(TextOr(browser, "role", ""));
    kept.browsers.push_back({TextOr(browser, "secret", ""), role.value_or(Role::kViewer)});
    if (!role || !IsToken(kept.browsers.back().secret)) {
      return unreadable();
    }
  }
  for (const Json& link : json["links"]) {
    const auto role = ParseRole(TextOr(link, "role", ""));
    kept.links.push_back(
        {TextOr(link, "token", ""), role.value_or(Role::kViewer), TextOr(link, "browser", "")});
    const SavedAccess::Link& read = kept.links.back();
    if (!role || !IsToken(read.token) || !(read.browser.empty() || IsToken(read.browser))) {
      return unreadable();
    }
  }
  for (const Role role : kRoles) {
    const auto at = static_cast<std::size_t>(role);
    if (at >= kept.links.size() || kept.links[at].role != role) {
      return unreadable();
    }
  }
  return kept;
}

Result<void> SaveAccess(const std::filesystem::path& file, const SavedAccess& access) {
  Json links = Json::array();
  for (const SavedAccess::Link& link : access.links) {
    links.push_back(
        {{"token", link.token}, {"role", ToString(link.role)}, {"browser", link.browser}});
  }
  Json browsers = Json::array();
  for (const SavedAccess::Browser& browser : access.browsers) {
    browsers.push_back({{"secret", browser.secret}, {"role", ToString(browser.role)}});
  }
  const Json json{{"version", kAccessVersion},
                  {"port", access.port},
                  {"links", std::move(links)},
                  {"browsers", std::move(browsers)}};
  return WriteAtomically(file, json.dump(1), FileReaders::kOwner);
}

}  // namespace hvas::studio
