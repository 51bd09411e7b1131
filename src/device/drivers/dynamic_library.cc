#include "device/drivers/dynamic_library.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <system_error>

#include <dlfcn.h>
#include <elf.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/regular_file.h"

namespace hvas::device {
namespace {

namespace fs = std::filesystem;

constexpr std::array kSystemFolders{"/usr/local/lib", "/usr/lib", "/usr/lib64",
                                    "/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu"};

/** A folder of the real file system, as a path under another root. */
fs::path Under(const fs::path& root, const fs::path& folder) {
  return root / folder.relative_path();
}

std::vector<fs::path> FilesBeginning(const fs::path& folder, const std::string& beginning) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (entry->path().filename().string().starts_with(beginning)) {
      files.push_back(entry->path());
    }
  }
  std::sort(files.rbegin(), files.rend());  // The highest version first.
  return files;
}

std::vector<fs::path> FilesNamed(const fs::path& folder, const std::string& name) {
  if (name.ends_with('*')) {
    return FilesBeginning(folder, name.substr(0, name.size() - 1));
  }
  std::error_code ignored;
  const fs::path file = folder / name;
  return fs::exists(file, ignored) ? std::vector{file} : std::vector<fs::path>();
}

/** What the head of a file says that it is for; nothing where it is no ELF file. */
struct Machine {
  unsigned char word_size;
  std::uint16_t processor;

  bool operator==(const Machine&) const = default;
};

std::optional<Machine> ReadMachine(const fs::path& file) {
  const std::string head = ReadFileHead(file, sizeof(Elf64_Ehdr)).value_or(std::string());
  constexpr std::size_t kUsed = 20;  // Bytes, up to the processor.
  if (head.size() < kUsed || !head.starts_with(std::string_view(ELFMAG, SELFMAG))) {
    return std::nullopt;
  }
  const auto low = static_cast<unsigned char>(head[18]);
  const auto high = static_cast<unsigned char>(head[19]);
  return Machine{static_cast<unsigned char>(head[EI_CLASS]),
                 static_cast<std::uint16_t>(low | (high << 8))};
}

/** Why a file that is there could not be loaded, from the loader's words. */
Error ExplainFailure(const LibrarySearch& search, const fs::path& file, const std::string& words) {
  const auto machine = ReadMachine(file);
  if (!machine) {
    return {ErrorCode::kUnsupported,
            fmt::format("{} of {} is not a library: it is damaged or a placeholder",
                        file.filename().string(), search.title),
            file.string(), "install it again; " + search.remedy};
  }
  if (machine != ReadMachine("/proc/self/exe")) {
    return {ErrorCode::kUnsupported,
            fmt::format("{} of {} is built for another processor architecture",
                        file.filename().string(), search.title),
            file.string(), "install the edition for the architecture of this machine (uname -m)"};
  }
  const std::string missing = words.substr(0, words.find(':'));
  const bool lacks_another =
      words.find("cannot open shared object file") != std::string::npos && missing != file.string();
  if (lacks_another) {
    return {ErrorCode::kUnsupported,
            fmt::format("{} of {} needs {}, which is not installed", file.filename().string(),
                        search.title, missing),
            file.string(),
            fmt::format("install the package with {} (\"apt-file search {}\" finds it), or a newer "
                        "version of {}",
                        missing, missing, search.title)};
  }
  return {
      ErrorCode::kUnsupported,
      fmt::format("{} of {} cannot be loaded: {}", file.filename().string(), search.title, words),
      file.string(), "install it again; " + search.remedy};
}

/** That no file was found, in which folders, and how one comes by it. */
Error LibraryMissing(const LibrarySearch& search) {
  std::vector<std::string> folders;
  for (const fs::path& folder : search.folders) {
    folders.push_back(folder.string());
  }
  return {ErrorCode::kNotFound,
          fmt::format("the library of {} ({}) is not installed", search.title,
                      fmt::join(search.names, ", ")),
          fmt::format("{}{}", fmt::join(folders, ":"),
                      search.asks_loader ? " and the loader's own path" : ""),
          search.remedy};
}

struct Opened {
  void* handle;
  std::string words;  ///< Of the loader, when it could not.
};

Opened OpenLibrary(const std::string& file) {
  void* handle = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_GLOBAL);
  const char* words = handle == nullptr ? ::dlerror() : nullptr;
  return {handle, words != nullptr ? words : ""};
}

}  // namespace

LibrarySearch MakeLibrarySearch(const Surroundings& surroundings,
                                const std::vector<std::pair<std::string, std::string>>& variables,
                                const std::vector<std::string>& usual) {
  LibrarySearch search;
  search.folders = surroundings.library_folders;
  const bool is_whole_machine = surroundings.root == "/";
  for (const auto& [variable, below] : variables) {
    const char* value = std::getenv(variable.c_str());
    if (is_whole_machine && value != nullptr && *value != '\0') {
      search.folders.push_back(fs::path(value) / below);
    }
  }
  for (const std::string& folder : usual) {
    search.folders.push_back(Under(surroundings.root, folder));
  }
  for (const char* folder : kSystemFolders) {
    search.folders.push_back(Under(surroundings.root, folder));
  }
  search.asks_loader = is_whole_machine;
  return search;
}

std::vector<fs::path> LookForLibrary(const LibrarySearch& search,
                                     std::vector<Finding>* looked_for) {
  std::vector<fs::path> found;
  for (const fs::path& folder : search.folders) {
    for (const std::string& name : search.names) {
      const std::vector<fs::path> files = FilesNamed(folder, name);
      if (files.empty()) {
        looked_for->push_back({name, folder.string(), false, ""});
      }
      for (const fs::path& file : files) {
        if (std::find(found.begin(), found.end(), file) == found.end()) {
          looked_for->push_back({file.filename().string(), folder.string(), true, ""});
          found.push_back(file);
        }
      }
    }
  }
  return found;
}

void ProbeFiles(const LibrarySearch& search, ProbeReport* report) {
  if (LookForLibrary(search, &report->looked_for).empty()) {
    report->problems.push_back(LibraryMissing(search));
  }
}

Result<DynamicLibrary> DynamicLibrary::Load(const LibrarySearch& search,
                                            std::vector<Finding>* looked_for) {
  std::optional<Error> failure;
  for (const fs::path& file : LookForLibrary(search, looked_for)) {
    const auto checked = CheckRegularFile(file);  // The loader would wait for a pipe.
    const Opened opened =
        checked ? OpenLibrary(file.string()) : Opened{nullptr, checked.error().message};
    if (opened.handle != nullptr) {
      return DynamicLibrary(opened.handle, file.string());
    }
    const auto place = std::find_if(looked_for->begin(), looked_for->end(), [&](const Finding& f) {
      return f.is_found && f.what == file.filename() && f.where == file.parent_path();
    });
    place->note = opened.words;
    if (!failure) {
      failure = ExplainFailure(search, file, opened.words);
    }
  }
  for (const std::string& name : search.names) {
    if (!search.asks_loader || name.ends_with('*')) {
      continue;
    }
    const Opened opened = OpenLibrary(name);
    looked_for->push_back({name, "the loader's own path", opened.handle != nullptr, opened.words});
    if (opened.handle != nullptr) {
      return DynamicLibrary(opened.handle, name);
    }
  }
  return Unexpected(failure ? *failure : LibraryMissing(search));
}

void* DynamicLibrary::Find(const char* symbol) const {
  return ::dlsym(handle_, symbol);
}

Result<DynamicLibrary> LoadFunctions(const LibrarySearch& search, std::vector<Finding>* looked_for,
                                     const std::function<void(SymbolBinder*)>& bind) {
  auto library = DynamicLibrary::Load(search, looked_for);
  if (!library) {
    return library;
  }
  SymbolBinder binder(*library);
  bind(&binder);
  const bool is_old = !search.old_function.empty() && library->Has(search.old_function.c_str());
  if (!binder.missing().empty() && is_old) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the library of {} has version {}; {} is needed", search.title,
                            search.old_version, search.version),
                library->path(), search.remedy);
  }
  if (!binder.missing().empty()) {
    return Fail(
        ErrorCode::kUnsupported,
        fmt::format("the library of {} has no function {}; HVAS needs another version of it",
                    search.title, fmt::join(binder.missing(), ", ")),
        library->path(), fmt::format("{} is needed; {}", search.version, search.remedy));
  }
  return library;
}

}  // namespace hvas::device
