#include "cad/scene/placed_parts.h"

#include <fmt/format.h>

namespace hvas::cad {
namespace {

constexpr double kNodesPerPart =
    4;  // Subassemblies count too, and real files have fewer than parts.
constexpr const char* kAllowMoreParts = "raise --max-parts, or open one of the subassemblies";

}  // namespace

double CountPlaced(const Uses& uses, const std::vector<std::uint64_t>& roots) {
  struct Step {
    std::uint64_t definition;
    const std::vector<std::uint64_t>* used;  // Null for one that uses nothing.
    std::size_t next{0};
    double count{1};
  };

  std::unordered_map<std::uint64_t, double> known;  // 0 while it is being counted.
  const auto begin = [&](std::uint64_t definition) {
    known[definition] = 0;
    const auto found = uses.find(definition);
    return Step{definition, found == uses.end() ? nullptr : &found->second};
  };
  double total = 0;
  for (const std::uint64_t root : roots) {
    // This is no recursion: a chain may be longer than the stack.
    std::vector<Step> path;
    if (known.count(root) == 0) {
      path.push_back(begin(root));
    }
    while (!path.empty()) {
      Step& step = path.back();
      if (step.used == nullptr || step.next == step.used->size()) {
        known[step.definition] = step.count;
        path.pop_back();
        continue;
      }
      const std::uint64_t used = (*step.used)[step.next];
      const auto found = known.find(used);
      if (found == known.end()) {
        path.push_back(begin(used));  // Its count is taken when it is met again.
      } else {
        step.count += found->second;
        ++step.next;
      }
    }
    total += known[root];
  }
  return total;
}

Result<void> CheckPlaced(double placed, std::size_t most, const std::string& name) {
  if (placed <= kNodesPerPart * static_cast<double>(most)) {
    return {};
  }
  return Fail(ErrorCode::kUnsupported,
              fmt::format("the file places {:.6g} parts and subassemblies; the limit is {} parts",
                          placed, most),
              name, kAllowMoreParts);
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
