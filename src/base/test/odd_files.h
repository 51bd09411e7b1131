#pragma once

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hvas::testing {

/** What can stand where a file should and is none. */
struct OddFile {
  std::string kind;  ///< What error messages call it.
  std::filesystem::path path;
};

/** A folder, a pipe that nobody writes to, a socket, and links to a device that never ends and to
 the pipe, each at `folder`/NUMBER/`name`. */
inline std::vector<OddFile> MakeOddFiles(const std::filesystem::path& folder,
                                         const std::string& name) {
  namespace fs = std::filesystem;
  std::vector<OddFile> files;
  const auto place = [&](const std::string& kind) {
    const fs::path own = folder / std::to_string(files.size());
    fs::create_directories(own);
    files.push_back({kind, own / name});
    return own / name;
  };
  fs::create_directory(place("a folder"));
  const fs::path pipe = place("a pipe");
  ::mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR);
  // The name is relative, as an address of a socket is short.
  const fs::path socket = place("a socket");
  const fs::path before = fs::current_path();
  fs::current_path(socket.parent_path());
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw std::runtime_error("no socket can be made in " + socket.parent_path().string());
  }
  ::close(descriptor);
  fs::current_path(before);
  fs::create_symlink("/dev/zero", place("a device"));
  fs::create_symlink(pipe, place("a pipe"));
  return files;
}

}  // namespace hvas::testing
