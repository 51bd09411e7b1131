#include "cad/scene/mesh_folder_document.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/regular_file.h"
#include "cad/mesh_folder.h"
#include "cad/scene/mesh_document.h"
#include "cad/scene/mesh_format.h"
#include "cad/scene/placed_parts.h"
#include "cad/scene/product_tree.h"

namespace hvas::cad {
namespace {

namespace fs = std::filesystem;

using product::Occurrence;
using product::Part;
using product::PartId;
using product::Product;
using product::SubassemblyId;

constexpr const char* kUnitNote = "assumed-unit";

/** Numbers of parts of one file, as PartFn gets them; parts of the next file begin after them. */
constexpr std::uint32_t kNumbersOfFile = 1U << 16U;

/** The files of a folder, one after the other, as one product. */
class FolderReader {
 public:
  FolderReader(const fs::path& folder, const ImportOptions& options, const ReadWatch& watch,
               Diagnostics* diagnostics)
      : options_(options),
        watch_(watch),
        diagnostics_(diagnostics),
        files_(ListMeshFiles(folder)),
        product_(NameAfter(folder)),
        tree_(&product_) {}

  Result<Product> Read() {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      Diagnostics found;
      Result<Product> product = ReadFile(i, &found);
      Report(found, files_[i]);
      if (!product) {
        LeaveOut(product.error(), files_[i]);
      } else if (product_.occurrences.size() + product->occurrences.size() > options_.max_parts) {
        return FailTooManyParts(options_.max_parts, product_.source);
      } else {
        Add(std::move(*product));
      }
    }
    if (product_.occurrences.empty()) {
      return Unexpected(*first_error_);
    }
    tree_.Finish();
    return std::move(product_);
  }

 private:
  static Product NameAfter(const fs::path& folder) {
    Product product;
    product.name = folder.filename().string();
    product.source = product.name;
    return product;
  }

  Result<Product> ReadFile(std::size_t i, Diagnostics* found) {
    const fs::path& file = files_[i];
    constexpr std::size_t kHead = 4096;  // [bytes] in which a format's mark is looked for.
    const std::string head = ReadFileHead(file, kHead).value_or(std::string());
    const std::optional<MeshFormat> format = FindMeshFormat(file, head);
    if (!format) {
      return Fail(ErrorCode::kUnreadable, "the file is no mesh", file.filename().string(),
                  "export the part again");
    }
    const auto first = static_cast<std::uint32_t>(i) * kNumbersOfFile;
    ImportOptions options = options_;
    options.skipped_parts.clear();
    for (const std::uint32_t part : options_.skipped_parts) {
      if (part >= first && part - first < kNumbersOfFile) {
        options.skipped_parts.push_back(part - first);
      }
    }
    std::vector<fs::path> referred;
    ReadWatch watch;
    watch.referred_files = &referred;
    if (watch_.progress) {
      watch.progress = [this, i](std::string_view stage, double fraction) {
        watch_.progress(stage,
                        (static_cast<double>(i) + fraction) / static_cast<double>(files_.size()));
      };
    }
    if (watch_.part) {
      watch.part = [this, first](std::uint32_t number, std::string_view name) {
        watch_.part(first + number, name);
      };
    }
    Result<Product> product = ReadMeshFile(file, *format, options, watch, found);
    if (watch_.referred_files != nullptr) {
      watch_.referred_files->insert(watch_.referred_files->end(), referred.begin(), referred.end());
    }
    return product;
  }

  /** Passes on what was found in a file; that files have no unit is said once. */
  void Report(const Diagnostics& found, const fs::path& file) {
    for (Diagnostic item : found.items()) {
      const bool is_unit = item.code == kUnitNote;
      if (is_unit && has_unit_note_) {
        continue;
      }
      has_unit_note_ = has_unit_note_ || is_unit;
      item.entity = is_unit ? product_.source
                    : item.entity == file.filename().string()
                        ? fmt::format("{}/{}", product_.source, item.entity)
                        : item.entity;
      diagnostics_->Add(std::move(item));
    }
  }

  void LeaveOut(const Error& error, const fs::path& file) {
    if (!first_error_) {
      first_error_ = error;
    }
    diagnostics_->Warn("part-skipped",
                       fmt::format("{}/{}", product_.source, file.filename().string()),
                       fmt::format("{}; the file is omitted", error.message), error.remedy);
  }

  void Add(Product file) {
    const std::size_t first = product_.parts.size();
    for (Part& part : file.parts) {
      part.id = PartId(product_.parts.size());
      product_.parts.push_back(std::move(part));
    }
    const bool is_part = file.occurrences.size() == 1;
    const SubassemblyId parent =
        is_part ? SubassemblyId(0) : tree_.AddSubassembly(SubassemblyId(0), file.name);
    for (const Occurrence& occurrence : file.occurrences) {
      tree_.AddOccurrence(parent, PartId(first + occurrence.part.index()),
                          is_part ? file.name : occurrence.name, occurrence.X_WB);
    }
  }

  const ImportOptions& options_;
  const ReadWatch& watch_;
  Diagnostics* diagnostics_;
  std::vector<fs::path> files_;
  Product product_;
  ProductTree tree_;
  std::optional<Error> first_error_;
  bool has_unit_note_{false};
};

}  // namespace

Result<Product> ReadMeshFolder(const fs::path& folder, const ImportOptions& options,
                               const ReadWatch& watch, Diagnostics* diagnostics) {
  return FolderReader(folder, options, watch, diagnostics).Read();
}

}  // namespace hvas::cad
