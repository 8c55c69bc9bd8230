#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <string>
#include <vector>

namespace evit {

/// Writes datasets into an HDF5 file, for tests.
class H5Maker {
 public:
  explicit H5Maker(const std::string& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
    EXPECT_GE(file_, 0);
  }
  ~H5Maker() { H5Fclose(file_); }
  H5Maker(const H5Maker&) = delete;
  H5Maker& operator=(const H5Maker&) = delete;

  /// Numbers of `stored` type from memory of `type`; groups are made as needed. An already compressed chunk
  /// instead of the numbers, for the filter `filter` with its values: `chunk` holds all rows.
  void Put(const std::string& name, hid_t stored, hid_t type, const void* data,
           const std::vector<hsize_t>& shape, int filter = 0, const std::string& chunk = "",
           const std::vector<unsigned>& values = {}) {
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    if (filter != 0) {
      H5Pset_chunk(how, static_cast<int>(shape.size()), shape.data());
      H5Pset_filter(how, filter, H5Z_FLAG_OPTIONAL, values.size(), values.data());
    }
    const hid_t set = H5Dcreate2(file_, name.c_str(), stored, space, links, how, H5P_DEFAULT);
    EXPECT_GE(set, 0) << name;
    if (filter != 0) {
      const std::vector<hsize_t> origin(shape.size(), 0);
      EXPECT_GE(H5Dwrite_chunk(set, H5P_DEFAULT, 0, origin.data(), chunk.size(), chunk.data()), 0);
    } else {
      EXPECT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), 0) << name;
    }
    H5Dclose(set), H5Pclose(how), H5Pclose(links), H5Sclose(space);
  }
  template <typename Number>
  void Put(const std::string& name, hid_t stored, const std::vector<Number>& numbers, hsize_t columns = 1) {
    std::vector<hsize_t> shape = {numbers.size() / columns};
    if (columns == 16) shape.insert(shape.end(), {4, 4});
    if (columns != 1 && columns != 16) shape.push_back(columns);
    Put(name, stored, Type(Number{}), numbers.data(), shape);
  }
  hid_t file() const { return file_; }

 private:
  static hid_t Type(double) { return H5T_NATIVE_DOUBLE; }
  static hid_t Type(std::int64_t) { return H5T_NATIVE_INT64; }
  hid_t file_;
};

}  // namespace evit
