#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tools/formats/vector/h5_handle.h"

namespace evit::formats {

/// A one-dimensional dataset of numbers. HDF5 converts between all numbers without a word (-1 to 65535, 12.5
/// to 12), so what is stored is looked at first: its class, its sign, the filters it needs. All functions
/// throw std::runtime_error naming file, dataset and remedy.
class H5Column {
 public:
  enum class Class { kInteger, kFloat };

  /// `file`: an open file, called `path`. Where `name` is missing, the message says that `layout` was
  /// expected.
  H5Column(hid_t file, const std::string& path, const std::string& name, const std::string& layout);

  Class number_class() const { return class_; }
  std::size_t bytes() const { return bytes_; }  // of one number as it is stored
  std::size_t size() const { return size_; }    // numbers

  /// Numbers [begin, begin + n) as whole ones. Throws where one has a fraction, `what` saying what that
  /// means.
  void Read(std::size_t begin, std::size_t n, const std::string& what, std::vector<std::int64_t>* out) const;
  void Read(std::size_t begin, std::size_t n, std::vector<double>* out) const;

  [[noreturn]] void Fail(const std::string& what) const;

 private:
  void ReadAs(hid_t type, std::size_t begin, std::size_t n, void* out) const;
  void RequireFilters() const;

  std::string path_, name_;
  H5Handle dataset_;
  Class class_ = Class::kInteger;
  bool unsigned_ = false;
  std::size_t bytes_ = 0, size_ = 0;
};

}  // namespace evit::formats
