#include "studio/connection_table.h"

#include <algorithm>
#include <utility>

namespace hvas::studio {

std::size_t ConnectionTable::Count(const Filter& fits) const {
  return static_cast<std::size_t>(std::count_if(
      entries_.begin(), entries_.end(), [&fits](const auto& each) { return fits(each.second); }));
}

bool ConnectionTable::CloseOldest(const Filter& fits) {
  const auto oldest = std::find_if(entries_.begin(), entries_.end(),
                                   [&fits](const auto& each) { return fits(each.second); });
  if (oldest == entries_.end()) {
    return false;
  }
  const auto close = std::move(oldest->second.close);
  entries_.erase(oldest);
  close();  // Pending operations fail, which ends their session.
  return true;
}

bool ConnectionTable::MakeRoom(std::size_t most, const Filter& fits) {
  return Count(fits) < most ||
         CloseOldest([&fits](const Entry& entry) { return fits(entry) && entry.is_idle; });
}

std::uint64_t ConnectionTable::Add(const std::string& address, std::function<void()> close) {
  std::map<std::string, std::size_t> strangers;  // By address.
  std::size_t count = 0;
  for (const auto& [number, entry] : entries_) {
    if (entry.group == Group::kStranger) {
      ++strangers[entry.address];
      ++count;
    }
  }
  if (count >= kMostStrangers) {
    const auto most =
        std::max_element(strangers.begin(), strangers.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    CloseOldest([&most](const Entry& entry) {
      return entry.group == Group::kStranger && entry.address == most->first;
    });
  }
  entries_[++last_] = {address, std::move(close)};
  return last_;
}

bool ConnectionTable::Enter(std::uint64_t number, const Visitor& visitor) {
  const auto found = entries_.find(number);
  if (found == entries_.end()) {
    return false;
  }
  Entry& entry = found->second;
  const Group group = visitor.is_owner ? Group::kOwner : Group::kGuest;
  if (entry.group == group && (visitor.is_owner || entry.link == visitor.link())) {
    return true;
  }
  const Entry* self = &entry;
  const auto is_of_group = [&](const Entry& one) { return &one != self && one.group == group; };
  const auto is_of_link = [&](const Entry& one) {
    return is_of_group(one) && one.link == visitor.link();
  };
  const std::size_t most = visitor.role == Role::kViewer ? kMostOfViewers : kMostOfLink;
  const bool has_place = visitor.is_owner
                             ? MakeRoom(kMostOfOwner, is_of_group)
                             : MakeRoom(most, is_of_link) && MakeRoom(kMostOfGuests, is_of_group);
  if (has_place) {
    entry.group = group;
    entry.link = visitor.link();
  }
  return has_place;
}

void ConnectionTable::SetIdle(std::uint64_t number, bool is_idle) {
  if (const auto found = entries_.find(number); found != entries_.end()) {
    found->second.is_idle = is_idle;
  }
}

}  // namespace hvas::studio
