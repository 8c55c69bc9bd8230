#include "tools/formats/hdf5/h5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tools/formats/hdf5/h5_chunk.h"
#include "tools/formats/hdf5/h5_filters.h"
#include "tools/formats/hdf5/h5_handle.h"

namespace evit::formats {
namespace {

constexpr std::size_t kMaxDatasets = 10'000;

// The value of an attribute or dataset that is one text, of fixed or any length; empty where it is none.
template <typename ReadAs>
std::string OneText(const H5Handle& type, const H5Handle& space, const ReadAs& read_as) {
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) return "";
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    const H5Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type.get()));
    if (read_as(memory.get(), &text) < 0 || text == nullptr) return "";
    std::string value = text;
    H5free_memory(text);
    return value;
  }
  std::string value(std::min<std::size_t>(H5Tget_size(type.get()), 1 << 16), '\0');
  if (value.size() != H5Tget_size(type.get()) || read_as(type.get(), value.data()) < 0) return "";
  return value.substr(0, value.find('\0'));
}

}  // namespace

bool H5File::Recognises(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to word
  return std::filesystem::is_regular_file(path) && H5Fis_hdf5(path.c_str()) > 0;
}

H5File::H5File(const std::string& path) : path_(path) {
  RegisterFilters();
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    throw std::runtime_error(
        path +
        ": is not a complete HDF5 file: cut off or damaged (download it again), or still being "
        "written or never closed (h5clear -s FILE)");
  file_ = std::shared_ptr<void>(nullptr, [file](void*) { H5Fclose(file); });
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    auto* names = static_cast<std::vector<std::string>*>(list);
    if (info->type == H5O_TYPE_DATASET) names->push_back(name);
    return names->size() > kMaxDatasets ? 1 : 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &datasets_, H5O_INFO_BASIC);
}

bool H5File::Has(const std::string& name) const {
  return std::find(datasets_.begin(), datasets_.end(), name) != datasets_.end();
}

H5Rows H5File::Open(const std::string& requested) const {
  const std::size_t colon = Has(requested) ? std::string::npos : requested.rfind(':');
  if (colon == std::string::npos) return {file_, path_, requested, ""};
  return {file_, path_, requested.substr(0, colon), requested.substr(colon + 1)};
}

std::string H5File::Attribute(const std::string& name) const {
  const H5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (H5Aexists(file.get(), name.c_str()) <= 0) return "";
  const H5Handle attribute(H5Aopen(file.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  return OneText(H5Handle(H5Aget_type(attribute.get()), H5Tclose),
                 H5Handle(H5Aget_space(attribute.get()), H5Sclose),
                 [&](hid_t type, void* out) { return H5Aread(attribute.get(), type, out); });
}

std::string H5File::Text(const std::string& name) const {
  if (!Has(name)) return "";
  const H5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const H5Handle dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  return OneText(
      H5Handle(H5Dget_type(dataset.get()), H5Tclose), H5Handle(H5Dget_space(dataset.get()), H5Sclose),
      [&](hid_t type, void* out) { return ReadChunks(dataset.get(), type, H5S_ALL, H5S_ALL, out); });
}

}  // namespace evit::formats
