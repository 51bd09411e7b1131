#include "studio/access.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>

namespace hvas::studio {
namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

bool IsPort(std::string_view text) {
  constexpr std::size_t kMostDigits = 5;
  return !text.empty() && text.size() <= kMostDigits &&
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

std::string MakeToken() {
  std::array<unsigned char, 32> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    throw std::runtime_error("the system gives no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kAlphabet[byte % kAlphabet.size()];  // 64 letters: each is as likely as the others
  }
  return token;
}

bool IsSameSecret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::optional<std::string> HostOf(std::string_view host_header) {
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

Access::Access(std::vector<std::string> names, std::uint16_t port, bool is_tls)
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
}

std::string Access::OriginOf(std::string_view host) const {
  constexpr std::uint16_t kHttp = 80;
  constexpr std::uint16_t kHttps = 443;
  // Browsers leave out the port that the scheme has anyway.
  const std::string suffix =
      port_ == (is_tls_ ? kHttps : kHttp) ? std::string() : fmt::format(":{}", port_);
  const bool is_v6 = host.find(':') != std::string_view::npos;
  return fmt::format("{}://{}{}{}{}", is_tls_ ? "https" : "http", is_v6 ? "[" : "", host,
                     is_v6 ? "]" : "", suffix);
}

bool Access::AllowsHost(std::string_view host_header) const {
  const std::optional<std::string> host = HostOf(host_header);
  return host && std::find(hosts_.begin(), hosts_.end(), *host) != hosts_.end();
}

bool Access::AllowsOrigin(std::string_view origin) const {
  return std::find(origins_.begin(), origins_.end(), origin) != origins_.end();
}

std::optional<Role> Access::FindRole(std::string_view secret,
                                     const std::array<std::string, kRoles.size()>& secrets) {
  // All are compared every time.
  std::optional<Role> role;
  for (const Role one : kRoles) {
    if (IsSameSecret(secret, secrets[static_cast<std::size_t>(one)])) {
      role = one;
    }
  }
  return role;
}

std::optional<Role> Access::RoleOfToken(std::string_view token) const {
  return FindRole(token, tokens_);
}

std::optional<Role> Access::RoleOfCookie(std::string_view cookie_header) const {
  return FindRole(FindCookie(cookie_header, cookie_name_).value_or(""), sessions_);
}

std::string Access::SetCookie(Role role) const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}", cookie_name_,
                     sessions_[static_cast<std::size_t>(role)], is_tls_ ? "; Secure" : "");
}

}  // namespace hvas::studio
