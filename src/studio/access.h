#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

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
[[nodiscard]] std::optional<Role> ParseRole(std::string_view name);

/** Whether a link of this role lets in one browser and no other. */
[[nodiscard]] constexpr bool IsForOne(Role role) {
  return role != Role::kViewer;
}

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

/** Who has come in, and by what: what one start of the studio leaves to the next. */
struct KeptAccess {
  struct Link {
    std::string token;
    Role role{Role::kViewer};
    std::string browser;  ///< Secret of the one that it has let in; empty: none yet.
  };

  struct Browser {
    std::string secret;  ///< That it shows as its cookie.
    Role role{Role::kViewer};
  };

  std::uint16_t port{0};  ///< That the addresses of the links have; 0: none.
  std::vector<Link> links;
  std::vector<Browser> browsers;
};

/** Errors: kNotFound when there is no such file; kInvalid when others can read it; kUnreadable for
 what is not of SaveAccess. */
[[nodiscard]] Result<KeptAccess> LoadAccess(const std::filesystem::path& file);

/** Into a file that nobody else can read. Errors: those of WriteAtomically. */
[[nodiscard]] Result<void> SaveAccess(const std::filesystem::path& file, const KeptAccess& access);

/** Who may speak with the server at all: the names that it answers to, where pages may come from,
 and the secrets. A link to steer lets one browser in, which gets a cookie of its own and may come
 by the link again; a link to look on is for whoever has it. Any thread. */
class Access {
 public:
  /** What lies unused is forgotten, the oldest first. */
  static constexpr std::size_t kMostLinks = 64;
  static constexpr std::size_t kMostBrowsers = 64;

  /** @param names  Hosts besides those of the loopback that it answers to.
   @param port  As the browser sees it.
   @param is_tls  Pages come by https.
   @param kept  Of the start before, which counts where it had the same port. */
  Access(std::vector<std::string> names, std::uint16_t port, bool is_tls, KeptAccess kept = {});

  /** As browsers write it, of a host name or an address. */
  [[nodiscard]] std::string OriginOf(std::string_view host) const;

  /** Against DNS rebinding: only names that are this machine's. */
  [[nodiscard]] bool AllowsHost(std::string_view host_header) const;

  /** Exactly one of the origins that this server's own page has, compared as a whole. */
  [[nodiscard]] bool AllowsOrigin(std::string_view origin) const;

  /** What came of a token. */
  struct Admission {
    Role role{Role::kViewer};
    std::string set_cookie;  ///< For whoever came.
  };

  /** Lets a browser in by a link's token.
   Errors (kNotFound): there is no such link; (kInvalid): it has let another browser in. */
  [[nodiscard]] Result<Admission> Admit(std::string_view token, std::string_view cookie_header);

  /** The role of a browser, from the Cookie header. */
  [[nodiscard]] std::optional<Role> RoleOfCookie(std::string_view cookie_header) const;

  /** Has the port in it: browsers keep the cookies of all ports of a host together, and two studios
   may run on one. */
  [[nodiscard]] const std::string& cookie_name() const { return cookie_name_; }

  /** The token of the link that the program prints. */
  [[nodiscard]] std::string token(Role role) const;

  /** The token of a link that lets one more browser in. */
  [[nodiscard]] std::string Invite(Role role);

  /** The token of a link that lets one more browser in: the same until one has come by it. */
  [[nodiscard]] std::string FindFresh(Role role);

  /** For the next start. */
  [[nodiscard]] KeptAccess Keep() const;

 private:
  [[nodiscard]] KeptAccess::Browser* FindBrowser(std::string_view secret);
  std::string AddLink(Role role);
  KeptAccess::Browser* AddBrowser();

  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
  std::string cookie_name_;
  std::uint16_t port_;
  bool is_tls_;
  mutable std::mutex mutex_;  ///< Protects what follows.
  KeptAccess known_;          ///< The first links are those that are printed, by role.
};

}  // namespace hvas::studio
