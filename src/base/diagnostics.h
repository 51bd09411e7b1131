#pragma once

#include <string>
#include <vector>

namespace hvas {

enum class Severity { kNote, kWarning, kError };

/** Something odd about an input that did not stop the work. */
struct Diagnostic {
  Severity severity{Severity::kWarning};
  std::string code;     ///< Stable key, for example "no-solid".
  std::string entity;   ///< The part, face or file that it is about.
  std::string message;  ///< One sentence.
  std::string remedy;   ///< What the reader can do; may be empty.
};

/** Collects what an import or a compilation found odd, in the order found. */
class Diagnostics {
 public:
  void Add(Diagnostic diagnostic) { items_.push_back(std::move(diagnostic)); }

  void Warn(std::string code, std::string entity, std::string message, std::string remedy = {}) {
    Add({Severity::kWarning, std::move(code), std::move(entity), std::move(message),
         std::move(remedy)});
  }

  void Note(std::string code, std::string entity, std::string message, std::string remedy = {}) {
    Add({Severity::kNote, std::move(code), std::move(entity), std::move(message),
         std::move(remedy)});
  }

  [[nodiscard]] const std::vector<Diagnostic>& items() const { return items_; }

  [[nodiscard]] int Count(Severity severity) const {
    int count = 0;
    for (const Diagnostic& item : items_) {
      count += item.severity == severity ? 1 : 0;
    }
    return count;
  }

 private:
  std::vector<Diagnostic> items_;
};

}  // namespace hvas
