// What decides who may speak with the studio: Host, Origin and Cookie of a request, a line each.
#include <algorithm>
#include <array>
#include <string>

#include "fuzz/target.h"
#include "studio/access.h"

namespace hvas::fuzz {
namespace {

std::string_view TakeLine(std::string_view* bytes) {
  const std::size_t end = bytes->find('\n');
  const std::string_view line = bytes->substr(0, end);
  *bytes = end == std::string_view::npos ? std::string_view() : bytes->substr(end + 1);
  return line;
}

void CheckHost(const studio::Access& access, std::string_view line) {
  constexpr std::array<std::string_view, 3> kOwn{"127.0.0.1", "localhost", "::1"};
  const auto host = studio::FindHost(line);
  if (host) {
    Check(!host->empty() && host->size() <= line.size());
    Check(std::none_of(host->begin(), host->end(), [](char c) { return c >= 'A' && c <= 'Z'; }));
  }
  Check(access.AllowsHost(line) ==
        (host && std::find(kOwn.begin(), kOwn.end(), *host) != kOwn.end()));
  if (access.AllowsHost(line)) {
    // A name of the loopback, perhaps in brackets, perhaps with a port.
    constexpr std::string_view kPossible = "127.0.0.1:[]0123456789localhostLOCALHOST";
    Check(line.find_first_not_of(kPossible) == std::string_view::npos);
  }
}

void CheckOrigin(const studio::Access& access, std::string_view line) {
  Check(access.AllowsOrigin(line) ==
        (line == "http://127.0.0.1:8123" || line == "http://localhost:8123" ||
         line == "http://[::1]:8123"));
}

/** @param pair  Name and value of the cookie of a browser that looks on. */
void CheckCookie(studio::Access* access, const std::string& pair, std::string_view line) {
  const auto value = studio::FindCookie(line, access->cookie_name());
  if (value) {
    Check(line.find(*value) != std::string_view::npos);
    Check(value->find(';') == std::string::npos);
  }
  Check(!access->FindVisitor(line));  // 192 random bits are not guessed
  Check(!access->Admit(line, line));
  // The right one is found behind whatever else is there.
  const auto is_viewer = [access](const std::string& header) {
    const auto visitor = access->FindVisitor(header);
    return visitor && visitor->role == studio::Role::kViewer;
  };
  Check(is_viewer(pair + ";" + std::string(line)));
  Check(value || is_viewer(std::string(line) + ";" + pair));
}

}  // namespace

void TestOne(std::string_view bytes) {
  static studio::Access access({}, 8123, false);
  static const std::string given =
      access.Admit(access.token(studio::Role::kViewer), "")->set_cookie;
  CheckHost(access, TakeLine(&bytes));
  CheckOrigin(access, TakeLine(&bytes));
  CheckCookie(&access, given.substr(0, given.find(';')), bytes);
}

}  // namespace hvas::fuzz
