#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "device/driver.h"

namespace hvas::device {

/** Which library a driver needs, and where it may be. */
struct LibrarySearch {
  std::string title;  ///< "OpenHaptics (3D Systems)"
  /** File names, best first; one that ends in * stands for all that begin so, newest first. */
  std::vector<std::string> names;
  std::vector<std::filesystem::path> folders;  ///< Ordered as they are searched.
  bool asks_loader{true};                      ///< Besides, on the loader's own path.
  std::string remedy;                          ///< How one comes by it.
  std::string version;  ///< Which one is needed, in words: "version 3.5 or later".
  /** A function that only an older version has, and which that is; may be empty. */
  std::string old_function;
  std::string old_version;
};

/** The search of a driver in some surroundings: first their own folders, then those that
 environment variables name, then the usual ones under their root.
 @param variables  Environment variable and folder below it, as {"FDSDK", "lib"}.
 @param usual  The vendor's own places, absolute; those of the system are added. */
LibrarySearch MakeLibrarySearch(const Surroundings& surroundings,
                                const std::vector<std::pair<std::string, std::string>>& variables,
                                const std::vector<std::string>& usual);

/** The files that a search comes upon, without opening any; what is looked for is noted. */
std::vector<std::filesystem::path> LookForLibrary(const LibrarySearch& search,
                                                  std::vector<Finding>* looked_for);

/** Looks for a library without opening any; that there is none becomes a problem. */
void ProbeFiles(const LibrarySearch& search, ProbeReport* report);

/** A vendor's library that the program runs with. It is never unloaded: drivers of devices fail
 when they are loaded a second time. */
class DynamicLibrary {
 public:
  /** Loads the first file of a search that can be. Each place is noted with the loader's words.
   Errors: kNotFound where there is none; kUnsupported where those that are there cannot be loaded:
   made for another processor, broken, or in need of something that is missing. */
  static Result<DynamicLibrary> Load(const LibrarySearch& search, std::vector<Finding>* looked_for);

  [[nodiscard]] const std::string& path() const { return path_; }

  /** Null where it has no such symbol. */
  [[nodiscard]] void* Find(const char* symbol) const;

  [[nodiscard]] bool Has(const char* symbol) const { return Find(symbol) != nullptr; }

  /** Whether it stands in for the vendor's: no other has this symbol. */
  [[nodiscard]] bool is_emulated() const { return Has("hvas_emulator"); }

 private:
  DynamicLibrary(void* handle, std::string path) : handle_(handle), path_(std::move(path)) {}

  void* handle_;
  std::string path_;
};

/** Takes a library's functions by name, and remembers those that it lacks. */
class SymbolBinder {
 public:
  explicit SymbolBinder(const DynamicLibrary& library) : library_(library) {}

  template <typename Function>
  void Bind(const char* name, Function** function) {
    BindOptional(name, function);
    if (*function == nullptr) {
      missing_.emplace_back(name);
    }
  }

  /** Binds what a driver can do without. */
  template <typename Function>
  void BindOptional(const char* name, Function** function) {
    *function = reinterpret_cast<Function*>(library_.Find(name));
  }

  [[nodiscard]] const std::vector<std::string>& missing() const { return missing_; }

 private:
  const DynamicLibrary& library_;
  std::vector<std::string> missing_;
};

/** Binds a function of a list of macros as HVAS_DHD_FUNCTIONS is one: by a SymbolBinder `binder`
 into a struct `functions` that has a pointer of its name. */
#define HVAS_BIND(name) binder->Bind(#name, &functions->name);
#define HVAS_BIND_OPTIONAL(name) binder->BindOptional(#name, &functions->name);

/** Loads a library and takes its functions.
 Errors: those of Load; kUnsupported, with the names, when it lacks any. */
Result<DynamicLibrary> LoadFunctions(const LibrarySearch& search, std::vector<Finding>* looked_for,
                                     const std::function<void(SymbolBinder*)>& bind);

/** The functions of a vendor's library. */
template <typename Functions>
struct VendorLibrary {
  Functions functions;
  bool is_emulated{false};
};

/** LoadFunctions for a struct of functions that has a BindAll beside it. */
template <typename Functions>
Result<VendorLibrary<Functions>> LoadVendorLibrary(const LibrarySearch& search,
                                                   std::vector<Finding>* looked_for) {
  VendorLibrary<Functions> library;
  const auto loaded = LoadFunctions(
      search, looked_for, [&](SymbolBinder* binder) { BindAll(binder, &library.functions); });
  if (!loaded) {
    return Unexpected(loaded.error());
  }
  library.is_emulated = loaded->is_emulated();
  return library;
}

/** How a driver's probe begins: looks for the files of its library, and loads it where devices may
 be opened. Gives nothing where they may not, or where it cannot be loaded, which becomes a problem.
 @param load  Result<Library>(std::vector<Finding>* looked_for) */
template <typename Load>
auto ProbeLibrary(const LibrarySearch& search, bool opens_devices, ProbeReport* report, Load load)
    -> std::optional<typename decltype(load(&report->looked_for))::value_type> {
  if (!opens_devices) {
    ProbeFiles(search, report);
    return std::nullopt;
  }
  auto library = load(&report->looked_for);
  if (!library) {
    report->problems.push_back(library.error());
    return std::nullopt;
  }
  return *std::move(library);
}

/** ProbeLibrary for a struct of functions that has a BindAll beside it. */
template <typename Functions>
std::optional<VendorLibrary<Functions>> ProbeVendorLibrary(const LibrarySearch& search,
                                                           bool opens_devices,
                                                           ProbeReport* report) {
  return ProbeLibrary(search, opens_devices, report, [&](std::vector<Finding>* looked_for) {
    return LoadVendorLibrary<Functions>(search, looked_for);
  });
}

}  // namespace hvas::device
