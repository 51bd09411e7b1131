#include "evidence/hdf5_writer.h"

#include <array>

namespace hvas::evidence {
namespace {

constexpr unsigned kDeflate = 4;  // A level from 0 to 9: a choice, not measured.

// The first call of HDF5.
hid_t CopyTextType() {
  // What a full disk did not take must not be tried again when the program ends: that crashes.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return H5Tcopy(H5T_C_S1);
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path)
    : text_(CopyTextType(), &H5Tclose),
      scalar_(H5Screate(H5S_SCALAR), &H5Sclose),
      file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), &H5Fclose) {
  Note(H5Tset_size(text_.id(), H5T_VARIABLE));
  Note(H5Tset_cset(text_.id(), H5T_CSET_UTF8));
  Note(file_.id());
}

void Hdf5Writer::Describe(hid_t object, const char* name, const std::string& text) {
  const Hdf5Handle attribute(
      H5Acreate2(object, name, text_.id(), scalar_.id(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
  const char* value = text.c_str();
  Note(attribute.id() < 0 ? -1 : H5Awrite(attribute.id(), text_.id(), &value));
}

void Hdf5Writer::Describe(hid_t object, const char* name, std::int64_t number) {
  const Hdf5Handle attribute(
      H5Acreate2(object, name, H5T_STD_I64LE, scalar_.id(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
  Note(attribute.id() < 0 ? -1 : H5Awrite(attribute.id(), H5T_NATIVE_INT64, &number));
}

Hdf5Handle Hdf5Writer::MakeGroup(hid_t parent, const char* name) {
  Hdf5Handle group(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
  Note(group.id());
  return group;
}

Hdf5Handle Hdf5Writer::MakeSet(hid_t group, const char* name, hsize_t width) {
  const int rank = width == 1 ? 1 : 2;
  const std::array<hsize_t, 2> none{0, width};
  const std::array<hsize_t, 2> any{H5S_UNLIMITED, width};
  const std::array<hsize_t, 2> block{kBlock, width};
  const Hdf5Handle space(H5Screate_simple(rank, none.data(), any.data()), &H5Sclose);
  const Hdf5Handle how(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
  Note(H5Pset_chunk(how.id(), rank, block.data()));
  Note(H5Pset_shuffle(how.id()));
  Note(H5Pset_deflate(how.id(), kDeflate));
  Hdf5Handle set(
      H5Dcreate2(group, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
      &H5Dclose);
  Note(set.id());
  return set;
}

void Hdf5Writer::Append(hid_t set, hsize_t at, const std::vector<double>& values, hsize_t width) {
  const int rank = width == 1 ? 1 : 2;
  const std::array<hsize_t, 2> begin{at, 0};
  const std::array<hsize_t, 2> count{values.size() / width, width};
  const std::array<hsize_t, 2> size{at + count[0], width};
  Note(H5Dset_extent(set, size.data()));
  const Hdf5Handle in_file(H5Dget_space(set), &H5Sclose);
  Note(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, begin.data(), nullptr, count.data(),
                           nullptr));
  const Hdf5Handle in_memory(H5Screate_simple(rank, count.data(), nullptr), &H5Sclose);
  Note(H5Dwrite(set, H5T_NATIVE_DOUBLE, in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()));
}

void Hdf5Writer::WriteTexts(hid_t group, const char* name, const std::vector<std::string>& texts) {
  std::vector<const char*> values;
  values.reserve(texts.size());
  for (const std::string& text : texts) {
    values.push_back(text.c_str());
  }
  const hsize_t count = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), &H5Sclose);
  const Hdf5Handle set(
      H5Dcreate2(group, name, text_.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      &H5Dclose);
  Note(set.id() < 0 || count == 0
           ? set.id()
           : H5Dwrite(set.id(), text_.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

bool Hdf5Writer::Flush() {
  Note(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL));
  return is_good_;
}

}  // namespace hvas::evidence
