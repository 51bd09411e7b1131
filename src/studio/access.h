#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hvas::studio {

/** What a client may do. */
enum class Role : std::uint8_t {
  kOperator,  ///< May hold the lease, and with it steer.
  kViewer,    ///< Looks on; may always switch the forces off.
  /** Of a study: may hold the lease, and sees nothing of what a study hides. */
  kParticipant,
};

inline constexpr std::array kRoles{Role::kOperator, Role::kViewer, Role::kParticipant};

[[nodiscard]] const char* ToString(Role role);

/** 192 random bits as 32 letters, digits, '-' and '_': for tokens and sessions. */
[[nodiscard]] std::string MakeToken();

/** Compares in a time that does not depend on where they differ. */
[[nodiscard]] bool IsSameSecret(std::string_view a, std::string_view b);

/** A name or address as it stands in a Host header, without the port; an IPv6 address without its
 brackets. Nothing where it is not well formed. */
[[nodiscard]] std::optional<std::string> HostOf(std::string_view host_header);

/** The value of one cookie of a Cookie header; nothing where it is not there. */
[[nodiscard]] std::optional<std::string> FindCookie(std::string_view cookie_header,
                                                    std::string_view name);

/** Who may speak with the server at all: the names that it answers to, where pages may come from,
 and the secrets. Immutable. */
class Access {
 public:
  /** @param names  Hosts besides those of the loopback that it answers to.
   @param port  As the browser sees it.
   @param is_tls  Pages come by https. */
  Access(std::vector<std::string> names, std::uint16_t port, bool is_tls);

  /** As browsers write it, of a host name or an address. */
  [[nodiscard]] std::string OriginOf(std::string_view host) const;

  /** Against DNS rebinding: only names that are this machine's. */
  [[nodiscard]] bool AllowsHost(std::string_view host_header) const;

  /** Exactly one of the origins that this server's own page has, compared as a whole. */
  [[nodiscard]] bool AllowsOrigin(std::string_view origin) const;

  /** The role that a token gives. */
  [[nodiscard]] std::optional<Role> RoleOfToken(std::string_view token) const;

  /** The role of a session, from the Cookie header. */
  [[nodiscard]] std::optional<Role> RoleOfCookie(std::string_view cookie_header) const;

  /** Has the port in it: browsers keep the cookies of all ports of a host together, and two studios
   may run on one. */
  [[nodiscard]] const std::string& cookie_name() const { return cookie_name_; }

  /** What Set-Cookie says to whoever came with a token of this role. */
  [[nodiscard]] std::string SetCookie(Role role) const;

  [[nodiscard]] const std::string& token(Role role) const {
    return tokens_[static_cast<std::size_t>(role)];
  }

 private:
  [[nodiscard]] static std::optional<Role> FindRole(
      std::string_view secret, const std::array<std::string, kRoles.size()>& secrets);

  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
  std::string cookie_name_;
  std::uint16_t port_;
  bool is_tls_;
  // By role.
  std::array<std::string, kRoles.size()> tokens_{MakeToken(), MakeToken(), MakeToken()};
  std::array<std::string, kRoles.size()> sessions_{MakeToken(), MakeToken(), MakeToken()};
};

}  // namespace hvas::studio
