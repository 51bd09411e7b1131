#include "sequence/blocking_graph.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace hvas::sequence {

using product::OccurrenceId;

namespace {

bool IsPartOf(const Unit& unit, OccurrenceId id) {
  return std::find(unit.begin(), unit.end(), id) != unit.end();
}

}  // namespace

BlockingGraph::BlockingGraph(Extraction* extraction, const Unit& parts)
    : extraction_(*extraction), parts_(parts), limit_(extraction->budget().left() / 4) {
  for (const OccurrenceId id : parts_) {
    std::vector<std::size_t>& own = own_directions_[id];
    for (const Vec3& direction : extraction_.ListDirections({id})) {
      own.push_back(AddDirection(direction));
    }
    for (const Vec3& direction : extraction_.ListContactDirections({id})) {
      own.push_back(AddDirection(direction));
    }
  }
}

std::size_t BlockingGraph::AddDirection(const Vec3& direction) {
  constexpr double kSame = 1 - 1e-6;  // cosine of the angle between directions that are one
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    if (directions_[i].dot(direction) > kSame) {
      return i;
    }
  }
  directions_.push_back(direction);
  return directions_.size() - 1;
}

bool BlockingGraph::IsThere(OccurrenceId id) const {
  return IsPartOf(parts_, id);
}

const BlockingGraph::Way* BlockingGraph::FindWay(OccurrenceId id, std::size_t direction) {
  const auto known = ways_.find({id, direction});
  if (known != ways_.end()) {
    return &known->second;
  }
  if (ways_.size() >= kMostWays || spent_ >= limit_) {
    is_limited_ = true;
    return nullptr;
  }
  const std::uint64_t before = extraction_.budget().spent();
  Way way;
  const OccurrenceId base = parts_.back();
  for (const Obstacle& obstacle : extraction_.ListObstacles({id}, directions_[direction], base)) {
    way.is_closed = way.is_closed || !IsThere(obstacle.occurrence) || obstacle.occurrence == base;
    way.obstacles.push_back(obstacle.occurrence);
  }
  spent_ += extraction_.budget().spent() - before;
  return &ways_.emplace(Key{id, direction}, std::move(way)).first->second;
}

Unit BlockingGraph::FindClosure(OccurrenceId id, std::size_t direction, std::size_t most) {
  Unit closure{id};
  for (std::size_t i = 0; i < closure.size(); ++i) {
    const Way* way = FindWay(closure[i], direction);
    if (way == nullptr || way->is_closed) {
      return {};
    }
    for (const OccurrenceId other : way->obstacles) {
      if (IsThere(other) && !IsPartOf(closure, other)) {
        closure.push_back(other);
      }
    }
    if (closure.size() > most) {
      return {};
    }
  }
  Unit sorted;
  std::copy_if(parts_.begin(), parts_.end(), std::back_inserter(sorted),
               [&closure](OccurrenceId part) { return IsPartOf(closure, part); });
  return sorted;
}

std::optional<BlockingGraph::Body> BlockingGraph::FindBody(const Neighbours& neighbours) {
  std::optional<Body> smallest;
  for (std::size_t direction = 0; direction < directions_.size(); ++direction) {
    for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
      const std::size_t most = smallest ? smallest->parts.size() - 1 : parts_.size() - 1;
      Unit body = most > 0 ? FindClosure(parts_[i], direction, most) : Unit();
      if (!body.empty() && AreConnected(body, neighbours) &&
          std::find(excluded_.begin(), excluded_.end(), body) == excluded_.end()) {
        smallest = Body{std::move(body), directions_[direction]};
      }
    }
  }
  return smallest;
}

std::size_t BlockingGraph::CountFreed(OccurrenceId gone) {
  std::set<OccurrenceId> rest(parts_.begin(), parts_.end());
  rest.erase(gone);
  const std::size_t before = rest.size();
  const auto is_free = [&](OccurrenceId id) {
    const std::vector<std::size_t>& own = own_directions_[id];
    return std::any_of(own.begin(), own.end(), [&](std::size_t direction) {
      const Way* way = FindWay(id, direction);
      return way != nullptr && !way->is_closed &&
             std::none_of(way->obstacles.begin(), way->obstacles.end(),
                          [&rest](OccurrenceId other) { return rest.contains(other); });
    });
  };
  for (bool is_moving = true; is_moving;) {
    is_moving = false;
    for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
      if (rest.contains(parts_[i]) && is_free(parts_[i])) {
        rest.erase(parts_[i]);
        is_moving = true;
      }
    }
  }
  return before - rest.size();
}

OccurrenceId BlockingGraph::FindGreatestBlocker() {
  OccurrenceId greatest;
  std::size_t most = 0;
  for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
    const std::size_t freed = CountFreed(parts_[i]);
    if (freed > most) {
      most = freed;
      greatest = parts_[i];
    }
  }
  return greatest;
}

}  // namespace hvas::sequence
