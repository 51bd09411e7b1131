#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

namespace hvas::product {

/** Limits of docs/limits.md that ended the recognition of a part's features, each once. */
class RecognitionLimits {
 public:
  /** @param what  The limit in words; outlives this object. */
  void Add(std::string_view what) {
    if (std::find(items_.begin(), items_.end(), what) == items_.end()) {
      items_.push_back(what);
    }
  }

  [[nodiscard]] const std::vector<std::string_view>& items() const { return items_; }

 private:
  std::vector<std::string_view> items_;
};

}  // namespace hvas::product
