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
  kOperator,  ///< May hold the lease of a hand, and so steer it.
  kViewer,    ///< May only look on, and switch the forces off at any time.
  /** A participant of a study: may hold a lease, and sees nothing that the study hides. */
  kParticipant,
};

inline constexpr std::array kRoles{Role::kOperator, Role::kViewer, Role::kParticipant};

[[nodiscard]] const char* ToString(Role role);
[[nodiscard]] std::optional<Role> ParseRole(std::string_view name);

/** Whether a link of this role admits a single browser. */
[[nodiscard]] constexpr bool IsSingleUse(Role role) {
  return role != Role::kViewer;
}

/** Who sends a request. The owner is the browser that was admitted by the first operator's link:
 what it may do is not lost with a lease. */
struct Visitor {
  Role role{Role::kViewer};
  bool is_owner{false};
  std::uint32_t browser{0};  ///< Number of its session, different for each browser; 0: none.

  /** Number of the link that it came by, whose users share their quotas: all viewers have one link,
   every other link admits a single browser. */
  [[nodiscard]] std::uint32_t link() const { return IsSingleUse(role) ? browser : 0; }
};

/** Name of what a visitor is in the audit log and in docs/access.md: "owner", "operator", "viewer"
 or "participant". */
[[nodiscard]] const char* ToString(const Visitor& visitor);

/** Draws 192 random bits, as 32 characters of base64url: a token of a link or a session's
 secret. */
[[nodiscard]] std::string MakeToken();

/** Compares two secrets in constant time: the duration does not depend on where they differ. */
[[nodiscard]] bool IsSameSecret(std::string_view a, std::string_view b);

/** Extracts the name or address from a Host header: without the port, and without the brackets of
 an IPv6 address. None where the header is malformed. */
[[nodiscard]] std::optional<std::string> FindHost(std::string_view host_header);

/** Finds the value of one cookie in a Cookie header. */
[[nodiscard]] std::optional<std::string> FindCookie(std::string_view cookie_header,
                                                    std::string_view name);

/** Links and browser sessions that one start of the studio hands on to the next. */
struct SavedAccess {
  struct Link {
    std::string token;
    Role role{Role::kViewer};
    std::string browser;  ///< Secret of the browser that it has admitted; empty: none yet.
  };

  struct Browser {
    std::string secret;  ///< Value of its session cookie.
    Role role{Role::kViewer};
    std::uint32_t number{0};  ///< Visitor::browser; not saved.
  };

  std::uint16_t port{0};  ///< Port in the addresses of the links; 0: none.
  std::vector<Link> links;
  std::vector<Browser> browsers;
};

/** Reads a file of SaveAccess. Errors: kNotFound when there is no such file; kInvalid when other
 users can read it; kUnreadable when SaveAccess has not written it. */
[[nodiscard]] Result<SavedAccess> LoadAccess(const std::filesystem::path& file);

/** Writes a file that only this user can read. Errors: those of WriteAtomically. */
[[nodiscard]] Result<void> SaveAccess(const std::filesystem::path& file, const SavedAccess& access);

/** Access control of the server: the host names that it answers to, the origins that its pages may
 have, the tokens of links and the secrets of browser sessions. A link of an operator or participant
 admits one browser, which gets a session cookie and may use the link again; a viewer's link admits
 every browser that has it, and takes nothing from one that has come by another link. Any thread may
 call it. */
class Access {
 public:
  /** Links, those that are printed among them; beyond it the oldest other one is removed. A choice.
   */
  static constexpr std::size_t kMaxLinks = 64;
  /** Browsers that the viewers' link admits; beyond it the oldest of them is removed, and no
   browser that has come by another link. A choice. */
  static constexpr std::size_t kMaxViewers = 32;

  /** @param names  Host names and addresses that it answers to besides those of the loopback.
   @param port  Port that the browser connects to.
   @param is_tls  Whether pages are served by https.
   @param kept  State of the previous start; ignored where that had another port. */
  Access(const std::vector<std::string>& names, std::uint16_t port, bool is_tls,
         SavedAccess kept = {});

  /** The origin of this server under a host name or address, as browsers write it. */
  [[nodiscard]] std::string OriginOf(std::string_view host) const;

  /** Whether a Host header names this machine; guards against DNS rebinding. */
  [[nodiscard]] bool AllowsHost(std::string_view host_header) const;

  /** Whether an Origin header equals one of the origins of this server's own pages. */
  [[nodiscard]] bool AllowsOrigin(std::string_view origin) const;

  /** Result of a token that was accepted. */
  struct Admission {
    Visitor visitor;
    bool has_changed{false};  ///< Whether there is something to save.
    std::string set_cookie;   ///< Set-Cookie header for the admitted browser.
  };

  /** Admits a browser by the token of a link.
   Errors: kNotFound when there is no such link; kInvalid when it has admitted another browser. */
  [[nodiscard]] Result<Admission> Admit(std::string_view token, std::string_view cookie_header);

  /** Takes the right to come in from all browsers but that of the first operator's link, and makes
   new links in place of all others. @returns whether the browser with this Cookie header is that
   one; nothing is changed otherwise. */
  [[nodiscard]] bool EndSharing(std::string_view cookie_header);

  /** Finds who has sent a Cookie header; none without a valid session. */
  [[nodiscard]] std::optional<Visitor> FindVisitor(std::string_view cookie_header) const;

  /** Name of the session cookie. It contains the port, because browsers share cookies between the
   ports of a host, and two studios may run on one host. */
  [[nodiscard]] const std::string& cookie_name() const { return cookie_name_; }

  /** Token of the link that the program prints for a role. */
  [[nodiscard]] std::string token(Role role) const;

  /** Makes a link that admits one more browser. @returns its token. */
  [[nodiscard]] std::string MakeInvitation(Role role);

  /** Token of an unused link of a role; makes a link when all of them have been used. */
  [[nodiscard]] std::string FindUnusedLink(Role role);

  /** Copies the state for the next start. */
  [[nodiscard]] SavedAccess Keep() const;

 private:
  [[nodiscard]] SavedAccess::Browser* FindBrowser(std::string_view secret);
  [[nodiscard]] Visitor MakeVisitor(const SavedAccess::Browser& browser) const;
  std::string AddLink(Role role);
  SavedAccess::Browser* AddBrowser(Role role);

  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
  std::string cookie_name_;
  std::uint16_t port_;
  bool is_tls_;
  mutable std::mutex mutex_;  ///< Protects what follows.
  std::uint32_t last_browser_{0};
  SavedAccess known_;  ///< The first links, in the order of kRoles, are those that are printed.
};

}  // namespace hvas::studio
