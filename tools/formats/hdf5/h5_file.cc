#include "tools/formats/hdf5/h5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "tools/formats/hdf5/h5_chunk.h"
#include "tools/formats/hdf5/h5_filters.h"
#include "tools/formats/hdf5/h5_handle.h"

namespace evit::formats {
namespace {

constexpr hsize_t kMaxRead = hsize_t{1} << 31;  // bytes at a time
constexpr std::size_t kChunkCache = 64U
                                    << 20;  // bytes: a chunk is decompressed once, not for each part of it
constexpr std::size_t kMaxDatasets = 10'000, kMaxColumns = 1 << 24;

template <typename Number>
hid_t MemoryType();
template <>
hid_t MemoryType<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}
template <>
hid_t MemoryType<std::uint16_t>() {
  return H5T_NATIVE_UINT16;
}
template <>
hid_t MemoryType<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t MemoryType<double>() {
  return H5T_NATIVE_DOUBLE;
}

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

// MATLAB stores columns first: its N x 4 is 4 x N here, and its N x 1 is 1 x N.
bool IsTransposed(const std::vector<hsize_t>& shape) {
  constexpr hsize_t kWidest = 16, kTelling = 32;  // columns; rows: fewer may be the other way round
  return shape.size() == 2 && shape[0] <= kWidest && shape[1] >= kTelling && shape[1] >= 8 * shape[0];
}

}  // namespace

struct H5Rows::Impl {
  std::shared_ptr<void> file;      // stays open as long as this is used
  std::string path, name, member;  // of a compound; empty: none
  H5Handle dataset;
  std::vector<hsize_t> shape;
  std::size_t along = 0;  // the dimension that rows follow one another in
  std::size_t columns = 1, chunk_rows = 1, bytes = 0;
  H5T_class_t type = H5T_NO_CLASS;
  bool is_signed = false;

  void ReadInto(std::size_t begin, std::size_t n, hid_t number, void* out) const;
  std::string WhyUnreadable() const;
};

// A filter that is not there is the likeliest reason; its number says which.
std::string H5Rows::Impl::WhyUnreadable() const {
  const H5Handle properties(H5Dget_create_plist(dataset.get()), H5Pclose);
  for (int k = 0; k < H5Pget_nfilters(properties.get()); ++k) {
    std::size_t n_values = 0;
    unsigned flags = 0, config = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties.get(), static_cast<unsigned>(k), &flags, &n_values,
                                               nullptr, 0, nullptr, &config);
    if (H5Zfilter_avail(filter) <= 0) return "is compressed with " + FilterRemedy(filter);
  }
  return "cannot be read: the file is damaged; download it again";
}

void H5Rows::Impl::ReadInto(std::size_t begin, std::size_t n, hid_t number, void* out) const {
  H5Handle only_member;
  hid_t memory_type = number;
  if (!member.empty()) {
    only_member = H5Handle(H5Tcreate(H5T_COMPOUND, H5Tget_size(number)), H5Tclose);
    H5Tinsert(only_member.get(), member.c_str(), 0, number);
    memory_type = only_member.get();
  }
  std::vector<hsize_t> start(shape.size(), 0), count = shape;
  start[along] = begin;
  count[along] = n;
  const H5Handle source(H5Dget_space(dataset.get()), H5Sclose),
      target(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
  H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  if (ReadChunks(dataset.get(), memory_type, target.get(), source.get(), out) < 0)
    throw std::runtime_error(path + ": dataset " + name + " " + WhyUnreadable());
}

const std::string& H5Rows::name() const { return impl_->name; }
std::size_t H5Rows::rows() const { return impl_->shape[impl_->along]; }
std::size_t H5Rows::columns() const { return impl_->columns; }
std::size_t H5Rows::chunk_rows() const { return impl_->chunk_rows; }
bool H5Rows::is_integer() const { return impl_->type == H5T_INTEGER || impl_->type == H5T_ENUM; }
bool H5Rows::is_number() const { return is_integer() || impl_->type == H5T_FLOAT; }
bool H5Rows::is_signed() const { return impl_->is_signed; }
bool H5Rows::is_compound() const { return impl_->type == H5T_COMPOUND; }
std::vector<std::string> H5Rows::members() const {
  std::vector<std::string> names;
  const H5Handle type(H5Dget_type(impl_->dataset.get()), H5Tclose);
  const int n = is_compound() ? H5Tget_nmembers(type.get()) : 0;
  for (int k = 0; k < n; ++k) {
    char* name = H5Tget_member_name(type.get(), static_cast<unsigned>(k));
    names.emplace_back(name == nullptr ? "" : name);
    H5free_memory(name);
  }
  return names;
}
std::size_t H5Rows::bytes() const { return impl_->bytes; }
std::optional<std::uint64_t> H5Rows::stored() const {
  const H5Handle properties(H5Dget_create_plist(impl_->dataset.get()), H5Pclose);
  if (H5Pget_layout(properties.get()) == H5D_VIRTUAL) return {};
  return H5Dget_storage_size(impl_->dataset.get());
}
void H5Rows::Fail(const std::string& what) const {
  throw std::runtime_error(impl_->path + ": " + impl_->name + ": " + what);
}

template <typename Number>
void H5Rows::Read(std::size_t begin, std::size_t n, std::vector<Number>* out) const {
  if (columns() == 0 || columns() > kMaxColumns) Fail("has no rows of numbers");
  if (n * columns() * sizeof(Number) > kMaxRead) Fail("is too large to be read at once");
  if (!is_number()) Fail("holds no numbers (text, or a compound)");
  out->resize(n * columns());
  hid_t type = MemoryType<Number>();
  // HDF5 would clip: -1 kept in 64 bits without sign is -1 again.
  if (type == H5T_NATIVE_INT64 && is_integer() && !is_signed()) type = H5T_NATIVE_UINT64;
  if (n == 0) return;
  impl_->ReadInto(begin, n, type, out->data());
  if (impl_->along == 0 || columns() == 1) return;
  const std::vector<Number> across = *out;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < columns(); ++k) (*out)[row * columns() + k] = across[k * n + row];
  }
}
template void H5Rows::Read(std::size_t, std::size_t, std::vector<std::uint8_t>*) const;
template void H5Rows::Read(std::size_t, std::size_t, std::vector<std::uint16_t>*) const;
template void H5Rows::Read(std::size_t, std::size_t, std::vector<std::int64_t>*) const;
template void H5Rows::Read(std::size_t, std::size_t, std::vector<double>*) const;

template <typename Number>
std::vector<Number> H5Rows::ReadAll() const {
  std::vector<Number> values;
  Read(0, rows(), &values);
  return values;
}
template std::vector<std::int64_t> H5Rows::ReadAll() const;
template std::vector<double> H5Rows::ReadAll() const;

bool H5File::Recognises(const std::string& path) {
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
  const std::string name = requested.substr(0, colon);
  const H5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                      H5Fclose);  // the same file once more
  auto rows = std::make_shared<H5Rows::Impl>();
  rows->file = file_;
  rows->path = path_;
  rows->name = requested;
  if (colon != std::string::npos) rows->member = requested.substr(colon + 1);
  const H5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), 521, kChunkCache, 1);
  rows->dataset = H5Handle(H5Dopen2(file.get(), name.c_str(), access.get()), H5Dclose);
  if (!rows->dataset.ok()) throw std::runtime_error(path_ + ": dataset " + name + " is missing");
  const H5Handle space(H5Dget_space(rows->dataset.get()), H5Sclose),
      properties(H5Dget_create_plist(rows->dataset.get()), H5Pclose);
  const int rank = std::max(0, H5Sget_simple_extent_ndims(space.get()));
  rows->shape.resize(static_cast<std::size_t>(std::max(1, rank)), 1);
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), rows->shape.data(), nullptr);
  rows->along = IsTransposed(rows->shape) ? 1 : 0;
  for (std::size_t k = 0; k < rows->shape.size(); ++k) {
    if (k == rows->along) continue;
    rows->columns *= std::min<std::size_t>(rows->shape[k], kMaxColumns + 1);
    rows->columns = std::min(rows->columns, kMaxColumns + 1);
  }
  if (H5Pget_layout(properties.get()) == H5D_CHUNKED) {
    std::vector<hsize_t> chunk(rows->shape.size(), 1);
    H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
    rows->chunk_rows = std::max<hsize_t>(1, chunk[rows->along]);
  }
  H5Handle type(H5Dget_type(rows->dataset.get()), H5Tclose);
  if (!rows->member.empty()) {
    const int index =
        H5Tget_class(type.get()) == H5T_COMPOUND ? H5Tget_member_index(type.get(), rows->member.c_str()) : -1;
    if (index < 0) throw std::runtime_error(path_ + ": dataset " + name + " has no member " + rows->member);
    type = H5Handle(H5Tget_member_type(type.get(), static_cast<unsigned>(index)), H5Tclose);
  }
  rows->type = H5Tget_class(type.get());
  rows->bytes = H5Tget_size(type.get());
  rows->is_signed = rows->type == H5T_INTEGER && H5Tget_sign(type.get()) != H5T_SGN_NONE;
  return H5Rows(rows);
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

void H5File::ReadEvents(const H5Rows& rows, std::size_t begin, std::size_t n, std::vector<H5Event>* out) {
  const H5Handle type(H5Tcreate(H5T_COMPOUND, sizeof(H5Event)), H5Tclose);
  H5Tinsert(type.get(), "x", HOFFSET(H5Event, x), H5T_NATIVE_UINT16);
  H5Tinsert(type.get(), "y", HOFFSET(H5Event, y), H5T_NATIVE_UINT16);
  H5Tinsert(type.get(), "p", HOFFSET(H5Event, p), H5T_NATIVE_INT16);
  H5Tinsert(type.get(), "t", HOFFSET(H5Event, t), H5T_NATIVE_INT64);
  out->resize(n);
  if (n > 0) rows.impl_->ReadInto(begin, n, type.get(), out->data());
}

}  // namespace evit::formats
