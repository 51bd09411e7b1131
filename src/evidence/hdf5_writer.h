#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

namespace hvas::evidence {

/** An object of HDF5 that is closed by its own function. */
class Hdf5Handle {
 public:
  using Closer = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Closer close) : id_(id), close_(close) {}

  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;

  ~Hdf5Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }

  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
  Closer close_;
};

/** An HDF5 file that is being written. Keeps in mind whether all has gone well; HDF5 itself is kept
 from printing. */
class Hdf5Writer {
 public:
  static constexpr hsize_t kBlock = 4096;  ///< Rows that are written, and compressed, together.

  explicit Hdf5Writer(const std::filesystem::path& path);

  /** Adds an attribute. */
  void Describe(hid_t object, const char* name, const std::string& text);
  void Describe(hid_t object, const char* name, std::int64_t number);

  [[nodiscard]] Hdf5Handle MakeGroup(hid_t parent, const char* name);

  /** An empty set of rows of so many numbers, which can grow; one number: a column. */
  [[nodiscard]] Hdf5Handle MakeSet(hid_t group, const char* name, hsize_t width);

  /** Appends rows to a set. @param at  Rows that are there. @param values  Row by row. */
  void Append(hid_t set, hsize_t at, const std::vector<double>& values, hsize_t width = 1);

  void WriteTexts(hid_t group, const char* name, const std::vector<std::string>& texts);

  /** Whether everything was written. */
  [[nodiscard]] bool Flush();

  [[nodiscard]] hid_t root() const { return file_.id(); }

 private:
  void Note(hid_t outcome) { is_good_ = is_good_ && outcome >= 0; }

  Hdf5Handle text_;
  Hdf5Handle scalar_;
  Hdf5Handle file_;
  bool is_good_{true};
};

}  // namespace hvas::evidence
