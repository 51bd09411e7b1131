#include "studio/hand_leases.h"

#include <algorithm>

namespace hvas::studio {

std::vector<std::size_t> HandLeases::HandsOf(const std::string& client) const {
  std::vector<std::size_t> hands;
  for (std::size_t hand = 0; hand < leases_.size(); ++hand) {
    if (leases_[hand].client == client) {
      hands.push_back(hand);
    }
  }
  return hands;
}

std::vector<std::size_t> HandLeases::ListHandsInControl() const {
  std::vector<std::size_t> hands;
  for (std::size_t hand = 0; hand < leases_.size(); ++hand) {
    if (leases_[hand].client.empty() || leases_[hand].client == leases_[0].client) {
      hands.push_back(hand);
    }
  }
  return hands;
}

void HandLeases::Return(const std::string& client, const Visitor& visitor, bool takes_free,
                        std::int64_t now_ns) {
  EndWaits(now_ns);
  for (Lease& lease : leases_) {
    const bool is_its_own = lease.awaited != 0 && lease.awaited == visitor.browser;
    if (lease.client.empty() && (is_its_own || (takes_free && lease.awaited == 0))) {
      lease = {client, visitor.is_owner};
    }
  }
}

void HandLeases::Lose(const std::string& client, const Visitor& visitor, std::int64_t now_ns) {
  for (Lease& lease : leases_) {
    if (lease.client == client) {
      lease = {"", false, visitor.browser, now_ns + kWaitNs};
    }
  }
}

void HandLeases::Give(const std::vector<std::size_t>& hands, const std::string& client,
                      const Visitor& visitor) {
  for (const std::size_t hand : hands) {
    leases_[hand] = {client, visitor.is_owner};
  }
}

void HandLeases::Release(const std::vector<std::size_t>& hands) {
  for (const std::size_t hand : hands) {
    leases_[hand] = {};
  }
}

void HandLeases::EndWaits(std::int64_t now_ns) {
  for (Lease& lease : leases_) {
    if (lease.awaited != 0 && lease.awaited_ns <= now_ns) {
      lease = {};
    }
  }
}

HandLeases::Obstacle HandLeases::Request(const std::vector<std::size_t>& hands,
                                         const std::string& client, const Visitor& visitor,
                                         std::int64_t now_ns) {
  EndWaits(now_ns);
  Obstacle obstacle;
  for (const std::size_t hand : hands) {
    Lease& lease = leases_[hand];
    const bool takes_back = visitor.is_owner && !lease.is_owners;
    if (takes_back || lease.IsFreeFor(visitor.browser)) {
      lease = {client, visitor.is_owner};
    } else if (lease.client.empty()) {
      obstacle.wait_ns = std::max(obstacle.wait_ns, lease.awaited_ns - now_ns);
    } else if (lease.client != client) {
      obstacle.holder = lease.client;
    }
  }
  return obstacle;
}

}  // namespace hvas::studio
