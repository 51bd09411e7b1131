#include "cad/mesh_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/digest.h"
#include "cad/input_file.h"

namespace hvas::cad {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kExtensions{".3mf", ".gltf", ".glb", ".obj", ".stl"};

/** Place of a file's extension in the list; its length where it is none of them. */
std::size_t RankOf(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return static_cast<std::size_t>(std::find(kExtensions.begin(), kExtensions.end(), extension) -
                                  kExtensions.begin());
}

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

/** The digits at the beginning of a text, without leading zeros. */
std::string_view TakeNumber(std::string_view* text) {
  const auto is_over = std::find_if_not(text->begin(), text->end(), IsDigit);
  std::string_view number = text->substr(0, static_cast<std::size_t>(is_over - text->begin()));
  text->remove_prefix(number.size());
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

/** Compares names as people count: runs of digits by their value. */
bool IsBefore(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view m = TakeNumber(&a);
      const std::string_view n = TakeNumber(&b);
      if (m != n) {
        return m.size() != n.size() ? m.size() < n.size() : m < n;
      }
    } else if (a.front() != b.front()) {
      return a.front() < b.front();
    } else {
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() < b.size();
}

std::vector<fs::path> ListFolders(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(error) && !it->is_symlink(error)) {
      folders.push_back(it->path());
    }
  }
  return folders;
}

}  // namespace

std::vector<fs::path> ListMeshFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (RankOf(it->path()) < kExtensions.size() && it->is_regular_file(error)) {
      files.push_back(it->path());
    }
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const std::string stem_a = a.stem().string();
    const std::string stem_b = b.stem().string();
    if (stem_a != stem_b) {
      const bool is_before = IsBefore(stem_a, stem_b);
      return is_before != IsBefore(stem_b, stem_a) ? is_before : stem_a < stem_b;
    }
    return RankOf(a) != RankOf(b) ? RankOf(a) < RankOf(b) : a < b;
  });
  const auto is_other_format = [](const fs::path& a, const fs::path& b) {
    return a.stem() == b.stem();
  };
  files.erase(std::unique(files.begin(), files.end(), is_other_format), files.end());
  return files;
}

Result<fs::path> FindMeshFolder(const fs::path& folder) {
  std::error_code error;
  const fs::path path = fs::canonical(folder, error);
  if (error) {
    return Fail(ErrorCode::kNotFound, "there is no such folder", folder.string(), "check the path");
  }
  if (!ListMeshFiles(path).empty()) {
    return path;
  }
  std::vector<fs::path> holders = ListFolders(path);
  std::erase_if(holders, [](const fs::path& inner) { return ListMeshFiles(inner).empty(); });
  if (holders.size() == 1) {
    return holders.front();
  }
  return Fail(ErrorCode::kUnreadable,
              holders.empty()
                  ? std::string("this is a folder, not a file, and no mesh files are in it")
                  : fmt::format("this is a folder with {} folders of mesh files", holders.size()),
              folder.string(),
              holders.empty()
                  ? std::string(kFormats)
                  : fmt::format("choose one of them, as {}",
                                std::min_element(holders.begin(), holders.end())->string()));
}

std::string DigestOfMeshes(const fs::path& folder) {
  Digest digest;
  for (const fs::path& file : ListMeshFiles(folder)) {
    digest.AddText(file.filename().string());
    digest.AddText(DigestOf(file));
  }
  return digest.Hex();
}

}  // namespace hvas::cad
