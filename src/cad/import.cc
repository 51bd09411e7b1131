#include "cad/import.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <exception>
#include <fstream>
#include <mutex>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include <OSD.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_Failure.hxx>
#include <TDocStd_Document.hxx>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/assembly_tree.h"
#include "cad/step_document.h"
#include "cad/tolerances.h"

namespace hvas::cad {
namespace {

using product::Product;

/** While it lives a crash inside OpenCASCADE becomes a Standard_Failure; puts the handlers of the
 program back afterwards. */
class SignalScope {
 public:
  SignalScope() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      sigaction(kSignals[i], nullptr, &saved_[i]);
    }
    OSD::SetSignal(/*theFloatingSignal=*/false);
    // These are none of OpenCASCADE's business.
    for (const std::size_t i : {kInterrupt, kHangUp, kQuit, kTerminate}) {
      sigaction(kSignals[i], &saved_[i], nullptr);
    }
  }

  ~SignalScope() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      sigaction(kSignals[i], &saved_[i], nullptr);
    }
  }

  SignalScope(const SignalScope&) = delete;
  SignalScope& operator=(const SignalScope&) = delete;

 private:
  static constexpr std::array<int, 9> kSignals{SIGINT, SIGHUP, SIGQUIT, SIGTERM, SIGSEGV,
                                               SIGFPE, SIGBUS, SIGILL,  SIGSYS};
  static constexpr std::size_t kInterrupt = 0;
  static constexpr std::size_t kHangUp = 1;
  static constexpr std::size_t kQuit = 2;
  static constexpr std::size_t kTerminate = 3;
  std::array<struct sigaction, kSignals.size()> saved_{};
};

void CheckSize(const Product& product, Diagnostics* diagnostics) {
  const double size = product.box_W.size().norm();
  if (size > 50 || size < 1e-4) {
    diagnostics->Warn("implausible-size", product.source,
                      fmt::format("the product measures {:.6g} mm across", units::ToMm(size)),
                      "check the length unit of the file");
  }
}

/** The text of a file that states tolerances; empty where it states none, or cannot be had. */
std::string ReadToleranceText(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    return {};
  }
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return MayHoldTolerances(text) ? text : std::string();
}

/** Reads the tolerances into a product; whatever goes wrong with them is no more than a warning. */
void AddTolerances(std::string text, Product* product, Diagnostics* diagnostics) {
  if (text.empty()) {
    return;
  }
  try {
    ReadTolerances(std::move(text), product, diagnostics);
  } catch (const std::exception& exception) {
    diagnostics->Warn("tolerances-unread", product->source,
                      fmt::format("the tolerances could not be read: {}", exception.what()),
                      "export the file again from the CAD system");
  }
}

Result<Product> ImportChecked(const std::filesystem::path& file, const ImportOptions& options,
                              const ProgressFn& progress, Diagnostics* diagnostics) {
  std::string tolerance_text = ReadToleranceText(file);
  FaceEntityFn entity_of;
  const auto document =
      ReadStepDocument(file, progress, diagnostics, tolerance_text.empty() ? nullptr : &entity_of);
  if (!document) {
    return Unexpected(document.error());
  }
  Product product;
  product.name = file.stem().string();
  product.source = file.filename().string();
  const Result<void> built =
      BuildProduct(*document, options, progress, &product, diagnostics, entity_of);
  CloseDocument(*document);
  if (!built) {
    const auto missing =
        std::count_if(diagnostics->items().begin(), diagnostics->items().end(),
                      [](const Diagnostic& item) { return item.code == "missing-file"; });
    if (missing > 0) {
      return Fail(
          ErrorCode::kNotFound,
          fmt::format("the assembly keeps its parts in {} other files that are not there", missing),
          product.source, "put them beside the assembly");
    }
    return Unexpected(built.error());
  }
  AddTolerances(std::move(tolerance_text), &product, diagnostics);
  CheckSize(product, diagnostics);
  if (progress) {
    progress("done", 1);
  }
  return product;
}

/** The only place where exceptions of OpenCASCADE, and its crashes, end. */
Result<Product> ImportGuarded(const std::filesystem::path& file, const ImportOptions& options,
                              const ProgressFn& progress, Diagnostics* diagnostics) {
  constexpr const char* kRemedy = "export it again from the CAD system, if need be in parts";
  const std::string name = file.filename().string();
  try {
    OCC_CATCH_SIGNALS
    return ImportChecked(file, options, progress, diagnostics);
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

Result<Product> ImportStep(const std::filesystem::path& file, const ImportOptions& options,
                           Diagnostics* diagnostics, const ProgressFn& progress) {
  const Result<std::filesystem::path> path = CheckStepFile(file);
  if (!path) {
    return Unexpected(path.error());
  }
  static std::mutex mutex;  // OpenCASCADE keeps its settings and documents in globals.
  const std::scoped_lock lock(mutex);
  const SignalScope signals;
  return ImportGuarded(*path, options, progress, diagnostics);
}

}  // namespace hvas::cad
