#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "haptics/constraint_solver.h"
#include "studio/access.h"

namespace hvas::studio {

/** Which client leads which hand. A lease that ends with its client's connection waits for the
 client's browser, so that nobody else has the hand when a page is loaded again; the owner may take
 every hand at any time. For one thread. */
class HandLeases {
 public:
  /** Time for which a lease waits for the browser that has lost it [ns]: 30 s are enough for a page
   to load again, or a network to come back. A choice. */
  static constexpr std::int64_t kWaitNs = 30'000'000'000;

  /** Client that holds the lease of a hand; empty: nobody. */
  [[nodiscard]] const std::string& holder(std::size_t hand) const { return leases_[hand].client; }

  [[nodiscard]] static constexpr std::size_t size() { return haptics::kMaxHands; }

  [[nodiscard]] std::vector<std::size_t> HandsOf(const std::string& client) const;

  /** What a request without a hand is for: the hands of who leads hand 0, and those of nobody. */
  [[nodiscard]] std::vector<std::size_t> ListHandsInControl() const;

  /** Gives a client that has come the hands that wait for its browser.
   @param takes_free  Whether it gets those of nobody as well. */
  void Return(const std::string& client, const Visitor& visitor, bool takes_free,
              std::int64_t now_ns);

  /** Takes the hands of a client that has gone; they wait for its browser. */
  void Lose(const std::string& client, const Visitor& visitor, std::int64_t now_ns);

  /** Gives hands to a client. */
  void Give(const std::vector<std::size_t>& hands, const std::string& client,
            const Visitor& visitor);

  /** Takes hands from their clients; they wait for nobody. */
  void Release(const std::vector<std::size_t>& hands);

  /** What stands in the way of a request. */
  struct Obstacle {
    std::string holder;  ///< Client that has to agree; empty: none has to.
    std::int64_t wait_ns{
        0};  ///< Time until a hand is free that waits for another browser; 0: none.
  };

  /** Gives those hands to a client that nobody else may claim: to the owner all of them, but for
   those of another page of the owner's, which asks. */
  Obstacle Request(const std::vector<std::size_t>& hands, const std::string& client,
                   const Visitor& visitor, std::int64_t now_ns);

 private:
  struct Lease {
    std::string client;
    bool is_owners{false};       ///< The client is a page of the owner's.
    std::uint32_t awaited{0};    ///< Visitor::browser for which it waits; 0: for none.
    std::int64_t awaited_ns{0};  ///< Time at which the wait ends.

    [[nodiscard]] bool IsFreeFor(std::uint32_t browser) const {
      return client.empty() && (awaited == 0 || awaited == browser);
    }
  };

  /** Ends the wait for browsers that have not come back in time. */
  void EndWaits(std::int64_t now_ns);

  std::array<Lease, haptics::kMaxHands> leases_;
};

}  // namespace hvas::studio
