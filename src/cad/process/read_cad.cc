#include "cad/process/read_cad.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TDocStd_Document.hxx>
#include <fmt/format.h>

#include "base/regular_file.h"
#include "base/units.h"
#include "cad/brep/assembly_tree.h"
#include "cad/brep/iges_document.h"
#include "cad/brep/occt_session.h"
#include "cad/brep/step_document.h"
#include "cad/iges/iges_text.h"
#include "cad/input_file.h"
#include "cad/scene/mesh_document.h"
#include "cad/scene/mesh_folder_document.h"
#include "cad/scene/mesh_format.h"
#include "cad/step/identities.h"
#include "cad/step/step_measure.h"
#include "cad/step/tolerances.h"
#include "cad/triangles/tessellated.h"

namespace hvas::cad {
namespace {

using product::Product;

void CheckSize(const Product& product, Diagnostics* diagnostics) {
  const double size = product.box_W.size().norm();
  if (size > 50 || size < 1e-4) {
    diagnostics->Warn(
        "implausible-size", product.source,
        fmt::format("the product is {:.6g} mm across, an unusual size", units::ToMm(size)),
        "check the length unit of the file");
  }
}

/** A product with the names that it has where the file gives none. */
Product NameAfter(const std::filesystem::path& file) {
  Product product;
  product.name = file.stem().string();
  product.source = file.filename().string();
  return product;
}

/** Reads the tolerances into a product; whatever goes wrong with them is no more than a warning. */
void AddTolerances(const StepText& text, Product* product, Diagnostics* diagnostics) {
  try {
    ReadTolerances(text, product, diagnostics);
  } catch (const std::exception& exception) {
    diagnostics->Warn("tolerances-unread", product->source,
                      fmt::format("the tolerances could not be read: {}", exception.what()),
                      "export the file again from the CAD system");
  }
}

Result<Product> ReadSolids(const std::filesystem::path& file, const StepText& text,
                           const ImportOptions& options, const ReadWatch& watch,
                           Diagnostics* diagnostics) {
  const bool with_tolerances = options.with_tolerances && MayHoldTolerances(text.text());
  const auto document = ReadStepDocument(file, text, options, watch, diagnostics, with_tolerances);
  if (!document) {
    return Unexpected(document.error());
  }
  Product product = NameAfter(file);
  const Result<void> built = BuildProduct(*document, options, watch, &product, diagnostics);
  CloseDocument(document->document);
  if (!built) {
    const auto missing =
        std::count_if(diagnostics->items().begin(), diagnostics->items().end(),
                      [](const Diagnostic& item) { return item.code == "missing-file"; });
    if (missing > 0) {
      return Fail(ErrorCode::kNotFound,
                  fmt::format("the assembly refers to {} files of parts that are missing", missing),
                  product.source, "put the files beside the assembly");
    }
    return Unexpected(built.error());
  }
  if (watch.progress) {
    watch.progress("tolerances", 0);
  }
  if (with_tolerances) {
    AddTolerances(text, &product, diagnostics);
  }
  CheckSize(product, diagnostics);
  return product;
}

/** Whether a product read from surfaces has none, but curves. */
bool HasCurvesOnly(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.items().begin(), diagnostics.items().end(),
                     [](const Diagnostic& item) { return item.code == "curves-only"; });
}

/** A file without solids may have triangles in their place. */
Result<Product> ReadStep(const std::filesystem::path& file, const ImportOptions& options,
                         const ReadWatch& watch, Diagnostics* diagnostics) {
  StepText text(ReadStepFile(file, options, diagnostics));
  if (const auto checked = CheckLengthUnits(text, file.filename().string()); !checked) {
    return Unexpected(checked.error());
  }
  OverrideLengthUnit(options, &text);
  Diagnostics of_solids;
  Result<Product> solids = ReadSolids(file, text, options, watch, &of_solids);
  const bool is_over =
      solids ? !HasCurvesOnly(of_solids) : solids.error().code == ErrorCode::kUnsupported;
  if (is_over || !MayHoldTessellation(text.text())) {
    for (const Diagnostic& item : of_solids.items()) {
      diagnostics->Add(item);
    }
    return solids;
  }
  Product product = NameAfter(file);
  product.header = ReadStepHeader(text.text());
  if (const auto read = ReadTessellated(text, options, watch, &product, diagnostics); !read) {
    return Unexpected(read.error());
  }
  if (watch.progress) {
    watch.progress("tolerances", 0);
  }
  if (options.with_tolerances && MayHoldTolerances(text.text())) {
    AddTolerances(text, &product, diagnostics);
  }
  CheckSize(product, diagnostics);
  return product;
}

Result<Product> ReadIges(const std::filesystem::path& file, const ImportOptions& options,
                         const ReadWatch& watch, Diagnostics* diagnostics) {
  const auto document = ReadIgesDocument(file, options, watch, diagnostics);
  if (!document) {
    return Unexpected(document.error());
  }
  Product product = NameAfter(file);
  const Result<void> built = BuildProduct(*document, options, watch, &product, diagnostics);
  CloseDocument(document->document);
  if (!built) {
    return Unexpected(built.error());
  }
  CheckSize(product, diagnostics);
  return product;
}

/** The one place where formats are told apart: by content, whatever the file is called. */
Result<Product> ReadByContent(const std::filesystem::path& file, const ImportOptions& options,
                              const ReadWatch& watch, Diagnostics* diagnostics) {
  constexpr std::size_t kHead = 4096;  // [bytes] in which a format's mark is looked for.
  const std::string head = ReadFileHead(file, kHead).value_or(std::string());
  if (head.find("ISO-10303-21") != std::string::npos) {
    return ReadStep(file, options, watch, diagnostics);
  }
  if (IsIgesFile(file, head)) {
    return ReadIges(file, options, watch, diagnostics);
  }
  if (const std::optional<MeshFormat> format = FindMeshFormat(file, head)) {
    Result<Product> product = ReadMeshFile(file, *format, options, watch, diagnostics);
    if (product) {
      CheckSize(*product, diagnostics);
    }
    return product;
  }
  return Fail(ErrorCode::kUnreadable,
              "the file is neither a STEP file, nor an IGES file, nor a mesh",
              file.filename().string(), kFormats);
}

Result<Product> ReadFolder(const std::filesystem::path& folder, const ImportOptions& options,
                           const ReadWatch& watch, Diagnostics* diagnostics) {
  Result<Product> product = ReadMeshFolder(folder, options, watch, diagnostics);
  if (product) {
    CheckSize(*product, diagnostics);
  }
  return product;
}

/** The only place where exceptions of other libraries end. */
Result<Product> ReadGuarded(const std::filesystem::path& file, const ImportOptions& options,
                            const ReadWatch& watch, Diagnostics* diagnostics) {
  constexpr const char* kRemedy =
      "export the file again from the CAD system, if necessary in parts";
  const std::string name = file.filename().string();
  try {
    return std::filesystem::is_directory(file) ? ReadFolder(file, options, watch, diagnostics)
                                               : ReadByContent(file, options, watch, diagnostics);
  } catch (const Standard_OutOfMemory&) {
    return Fail(ErrorCode::kOutOfResource, "memory ran out while reading it", name, kRemedy);
  } catch (const Standard_Failure& failure) {
    return Fail(ErrorCode::kUnreadable,
                fmt::format("OpenCASCADE could not read it: {} {}", failure.DynamicType()->Name(),
                            failure.GetMessageString()),
                name, kRemedy);
  } catch (const std::bad_alloc&) {
    return Fail(ErrorCode::kOutOfResource, "memory ran out while reading it", name, kRemedy);
  } catch (const std::exception& exception) {
    return Fail(ErrorCode::kUnreadable, fmt::format("could not be read: {}", exception.what()),
                name, kRemedy);
  }
}

}  // namespace

Result<Product> ReadCad(const std::filesystem::path& file, const ImportOptions& options,
                        Diagnostics* diagnostics, const ReadWatch& watch) {
  const Result<std::filesystem::path> path = CheckInput(file);
  if (!path) {
    return Unexpected(path.error());
  }
  static std::mutex mutex;  // OpenCASCADE keeps its settings and documents in globals.
  const std::scoped_lock lock(mutex);
  Result<Product> product = ReadGuarded(*path, options, watch, diagnostics);
  if (product && watch.progress) {
    watch.progress("done", 1);
  }
  return product;
}

}  // namespace hvas::cad
