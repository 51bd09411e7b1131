#include "cad/scene/placed_parts.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace hvas::cad {
namespace {

constexpr double kNodesPerPart =
    4;  // Subassemblies count too, and real files have fewer than parts.
constexpr const char* kAllowMoreParts = "raise --max-parts, or open one of the subassemblies";

/** Goes through definitions, each once, without recursion: a chain may be longer than the stack. */
class TreeWalk {
 public:
  explicit TreeWalk(const Uses& uses) : uses_(uses) {}

  PlacedTree Run(const std::vector<std::uint64_t>& roots) {
    for (const std::uint64_t root : roots) {
      const Known& known = Walk(root);
      tree_.count += known.count;
      tree_.levels = std::max(tree_.levels, known.levels);
    }
    // Libraries may go through what no root leads to.
    std::vector<std::uint64_t> all;
    for (const auto& [definition, used] : uses_) {
      all.push_back(definition);
    }
    std::sort(all.begin(), all.end());
    for (const std::uint64_t definition : all) {
      Walk(definition);
    }
    return std::move(tree_);
  }

 private:
  struct Known {
    double count{1};
    std::size_t levels{1};
    bool is_open{true};  // While what is below it is being walked through.
  };

  struct Step {
    std::uint64_t definition{0};
    const std::vector<std::uint64_t>* used{nullptr};  // Null for one that uses nothing.
    std::size_t next{0};
  };

  const Known& Walk(std::uint64_t root) {
    if (known_.count(root) == 0) {
      Enter(root);
    }
    while (!path_.empty()) {
      Step& step = path_.back();
      Known& own = known_[step.definition];
      if (step.used == nullptr || step.next == step.used->size()) {
        own.is_open = false;
        path_.pop_back();
        continue;
      }
      const std::uint64_t used = (*step.used)[step.next];
      const auto found = known_.find(used);
      if (found == known_.end()) {
        Enter(used);  // What it counts is taken when it is met again.
        continue;
      }
      ++step.next;
      if (found->second.is_open) {
        NoteCircle(used);
      } else {
        own.count += found->second.count;
        own.levels = std::max(own.levels, found->second.levels + 1);
      }
    }
    return known_[root];
  }

  void Enter(std::uint64_t definition) {
    known_[definition] = {};
    const auto found = uses_.find(definition);
    path_.push_back({definition, found == uses_.end() ? nullptr : &found->second});
  }

  void NoteCircle(std::uint64_t definition) {
    if (!tree_.circle.empty()) {
      return;
    }
    const auto begin = std::find_if(path_.begin(), path_.end(), [&](const Step& step) {
      return step.definition == definition;
    });
    std::transform(begin, path_.end(), std::back_inserter(tree_.circle),
                   [](const Step& step) { return step.definition; });
    tree_.circle.push_back(definition);
  }

  const Uses& uses_;
  std::unordered_map<std::uint64_t, Known> known_;
  std::vector<Step> path_;
  PlacedTree tree_;
};

}  // namespace

PlacedTree ExamineTree(const Uses& uses, const std::vector<std::uint64_t>& roots) {
  return TreeWalk(uses).Run(roots);
}

Result<void> CheckTree(const PlacedTree& tree, std::size_t most, const std::string& name,
                       std::string_view kind) {
  if (!tree.circle.empty()) {
    constexpr std::size_t kMostNamed = 8;  // A choice.
    const std::size_t named = std::min(tree.circle.size(), kMostNamed);
    return Fail(
        ErrorCode::kUnreadable,
        fmt::format("{}{}{} contains itself ({}{})", kind, kind.ends_with('#') ? "" : " ",
                    tree.circle.front(),
                    fmt::join(tree.circle.begin(),
                              tree.circle.begin() + static_cast<std::ptrdiff_t>(named), " > "),
                    named < tree.circle.size() ? " > ..." : ""),
        name, "correct the assembly in the CAD system and export it again");
  }
  if (tree.count > kNodesPerPart * static_cast<double>(most)) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the file places {:.6g} parts and subassemblies; the limit is {} parts",
                            tree.count, most),
                name, kAllowMoreParts);
  }
  if (tree.levels > kMostLevels) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the assembly is nested {} levels deep; the limit is {}", tree.levels,
                            kMostLevels),
                name, "export the product with fewer levels");
  }
  return {};
}

Unexpected FailTooManyParts(std::size_t most, const std::string& name) {
  return Fail(ErrorCode::kUnsupported, fmt::format("the file places more than {} parts", most),
              name, kAllowMoreParts);
}

Unexpected FailTooManyBytes(const std::string& what, double bytes, std::uint64_t most,
                            const std::string& name) {
  constexpr double kMebibyte = 1 << 20;  // Bytes.
  return Fail(ErrorCode::kUnsupported,
              fmt::format("{} {:.4g} MiB; the limit is {:.4g} MiB", what, bytes / kMebibyte,
                          static_cast<double>(most) / kMebibyte),
              name, "raise --memory-limit, or export the product in parts");
}

}  // namespace hvas::cad
