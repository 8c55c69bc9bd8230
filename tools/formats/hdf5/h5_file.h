#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/hdf5/h5_rows.h"

namespace evit::formats {

/// An HDF5 file that is read.
class H5File {
 public:
  static bool Recognises(const std::string& path);

  /// Throws std::runtime_error naming the file where it is not whole.
  explicit H5File(const std::string& path);
  bool Has(const std::string& name) const;
  /// A dataset, or one member of compounds: DATASET:MEMBER. Throws where there is no such.
  H5Rows Open(const std::string& requested) const;
  /// All datasets, by their paths ("events/x").
  const std::vector<std::string>& datasets() const { return datasets_; }
  /// A text of the file itself (attribute); empty where there is none.
  std::string Attribute(const std::string& name) const;
  /// A dataset that is one text; empty where there is none.
  std::string Text(const std::string& name) const;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::shared_ptr<void> file_;
  std::vector<std::string> datasets_;
};

}  // namespace evit::formats
