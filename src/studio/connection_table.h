#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "studio/access.h"

namespace hvas::studio {

/** Places for the open connections of the server. Strangers, who have not sent a valid session
 cookie, the users of each link, and the owner have places of their own, so that nobody keeps others
 out. Where a group has no place left, one of its own connections is closed in favour of the new
 one: the oldest one that waits for a request. For one thread. */
class ConnectionTable {
 public:
  // Choices: a browser opens six connections to a server, besides its WebSocket.
  static constexpr std::size_t kMostStrangers = 32;
  static constexpr std::size_t kMostOfLink = 16;     ///< Users of one link.
  static constexpr std::size_t kMostOfViewers = 48;  ///< All that came by the viewers' link.
  static constexpr std::size_t kMostOfGuests = 96;   ///< All but strangers and the owner.
  static constexpr std::size_t kMostOfOwner = 32;

  /** Adds a connection of a stranger; closes the oldest stranger of the address with the most of
   them when there is no place. @param close  Ends the connection's pending operations.
   @returns the connection's number. */
  std::uint64_t Add(const std::string& address, std::function<void()> close);

  /** Gives a connection, which has sent a valid cookie, a place of its visitor's. @returns false
   when the visitor's group has no place left: the connection stays a stranger's. */
  [[nodiscard]] bool Enter(std::uint64_t number, const Visitor& visitor);

  /** @param is_idle  Whether the connection waits for a request, and may be closed. */
  void SetIdle(std::uint64_t number, bool is_idle);

  void Remove(std::uint64_t number) { entries_.erase(number); }

 private:
  enum class Group : std::uint8_t { kStranger, kGuest, kOwner };

  struct Entry {
    std::string address;
    std::function<void()> close;
    Group group{Group::kStranger};
    std::uint32_t link{0};  ///< Visitor::link() of a guest.
    bool is_idle{true};
  };

  using Filter = std::function<bool(const Entry&)>;

  [[nodiscard]] std::size_t Count(const Filter& fits) const;
  /** Closes the oldest connection that fits. @returns false where there is none. */
  bool CloseOldest(const Filter& fits);
  /** Makes room for one more among those that fit. @returns false where none of them is idle. */
  bool MakeRoom(std::size_t most, const Filter& fits);

  std::map<std::uint64_t, Entry> entries_;  ///< Key: number, hence in the order of arrival.
  std::uint64_t last_{0};
};

}  // namespace hvas::studio
