#include "cad/scene/confined_io.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <system_error>

#include <assimp/DefaultIOSystem.h>
#include <assimp/IOStream.hpp>

namespace hvas::cad {

namespace fs = std::filesystem;

ConfinedIo::ConfinedIo(const fs::path& file, Log* log) : folder_(file.parent_path()), log_(log) {}

fs::path ConfinedIo::Resolve(const char* name) const {
  const fs::path asked(name);
  std::error_code error;
  const fs::path path = fs::weakly_canonical(asked.is_absolute() ? asked : folder_ / asked, error);
  const auto [end, at] = std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end());
  return error || end != folder_.end() || at == path.end() ? fs::path() : path;
}

bool ConfinedIo::Exists(const char* name) const {
  std::error_code error;
  const fs::path path = Resolve(name);
  return !path.empty() && fs::is_regular_file(path, error);
}

Assimp::IOStream* ConfinedIo::Open(const char* name, const char* mode) {
  const fs::path path = Resolve(name);
  std::error_code error;
  if (path.empty() || std::string_view(mode).find('r') == std::string_view::npos) {
    log_->refused.emplace_back(name);
    return nullptr;
  }
  if (!fs::is_regular_file(path, error)) {
    log_->missing.push_back(path);
    return nullptr;
  }
  log_->read.push_back(path);
  return Assimp::DefaultIOSystem().Open(path.c_str(), "rb");
}

void ConfinedIo::Close(Assimp::IOStream* stream) {
  delete stream;
}

}  // namespace hvas::cad
