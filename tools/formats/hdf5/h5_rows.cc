#include "tools/formats/hdf5/h5_rows.h"

#include <hdf5.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "tools/formats/hdf5/h5_chunk.h"
#include "tools/formats/hdf5/h5_filters.h"
#include "tools/formats/hdf5/h5_handle.h"

namespace evit::formats {
namespace {

constexpr hsize_t kMaxRead = hsize_t{1} << 31;  // bytes at a time
constexpr std::size_t kChunkCache = 64U
                                    << 20;  // bytes: a chunk is decompressed once, not for each part of it
constexpr std::size_t kMaxColumns = 1 << 24;

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

// MATLAB stores columns first: its N x 4 is 4 x N here, and its N x 1 is 1 x N.
bool IsTransposed(const std::vector<hsize_t>& shape) {
  constexpr hsize_t kWidest = 16, kTelling = 32;  // columns; rows: fewer may be the other way round
  return shape.size() == 2 && shape[0] <= kWidest && shape[1] >= kTelling && shape[1] >= 8 * shape[0];
}

}  // namespace

struct H5Rows::Impl {
  Impl(std::shared_ptr<void> open_file, std::string file_path, const std::string& dataset_name,
       std::string compound_member);

  std::shared_ptr<void> file;      // stays open as long as this is used
  std::string path, name, member;  // of a compound; empty: none
  H5Handle dataset;
  std::vector<hsize_t> shape;
  std::size_t along = 0;  // the dimension that rows follow one another in
  std::size_t columns = 1, chunk_rows = 1, bytes = 0;
  H5T_class_t type = H5T_NO_CLASS;
  bool is_signed = false;

  void OpenDataset(const std::string& dataset_name);
  void FindShape();
  void FindType(const std::string& dataset_name);
  void ReadInto(std::size_t begin, std::size_t n, hid_t number, void* out) const;
  std::string WhyUnreadable() const;
};

H5Rows::Impl::Impl(std::shared_ptr<void> open_file, std::string file_path, const std::string& dataset_name,
                   std::string compound_member)
    : file(std::move(open_file)), path(std::move(file_path)), member(std::move(compound_member)) {
  name = member.empty() ? dataset_name : dataset_name + ":" + member;
  OpenDataset(dataset_name);
  FindShape();
  FindType(dataset_name);
}

void H5Rows::Impl::OpenDataset(const std::string& dataset_name) {
  const H5Handle again(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);  // the same file
  const H5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), 521, kChunkCache, 1);
  dataset = H5Handle(H5Dopen2(again.get(), dataset_name.c_str(), access.get()), H5Dclose);
  if (!dataset.ok()) throw std::runtime_error(path + ": dataset " + dataset_name + " is missing");
}

void H5Rows::Impl::FindShape() {
  const H5Handle space(H5Dget_space(dataset.get()), H5Sclose),
      properties(H5Dget_create_plist(dataset.get()), H5Pclose);
  const int rank = std::max(0, H5Sget_simple_extent_ndims(space.get()));
  shape.resize(static_cast<std::size_t>(std::max(1, rank)), 1);
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  along = IsTransposed(shape) ? 1 : 0;
  for (std::size_t k = 0; k < shape.size(); ++k) {
    if (k == along) continue;
    columns *= std::min<std::size_t>(shape[k], kMaxColumns + 1);
    columns = std::min(columns, kMaxColumns + 1);
  }
  if (H5Pget_layout(properties.get()) == H5D_CHUNKED) {
    std::vector<hsize_t> chunk(shape.size(), 1);
    H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
    chunk_rows = std::max<hsize_t>(1, chunk[along]);
  }
}

void H5Rows::Impl::FindType(const std::string& dataset_name) {
  H5Handle number(H5Dget_type(dataset.get()), H5Tclose);
  if (!member.empty()) {
    const bool compound = H5Tget_class(number.get()) == H5T_COMPOUND;
    const int index = compound ? H5Tget_member_index(number.get(), member.c_str()) : -1;
    if (index < 0) throw std::runtime_error(path + ": dataset " + dataset_name + " has no member " + member);
    number = H5Handle(H5Tget_member_type(number.get(), static_cast<unsigned>(index)), H5Tclose);
  }
  type = H5Tget_class(number.get());
  bytes = H5Tget_size(number.get());
  is_signed = type == H5T_INTEGER && H5Tget_sign(number.get()) != H5T_SGN_NONE;
}

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

H5Rows::H5Rows(std::shared_ptr<void> file, const std::string& path, const std::string& dataset,
               const std::string& member)
    : impl_(std::make_shared<Impl>(std::move(file), path, dataset, member)) {}

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

void H5Rows::ReadEvents(std::size_t begin, std::size_t n, std::vector<H5Event>* out) const {
  const H5Handle type(H5Tcreate(H5T_COMPOUND, sizeof(H5Event)), H5Tclose);
  H5Tinsert(type.get(), "x", HOFFSET(H5Event, x), H5T_NATIVE_UINT16);
  H5Tinsert(type.get(), "y", HOFFSET(H5Event, y), H5T_NATIVE_UINT16);
  H5Tinsert(type.get(), "p", HOFFSET(H5Event, p), H5T_NATIVE_INT16);
  H5Tinsert(type.get(), "t", HOFFSET(H5Event, t), H5T_NATIVE_INT64);
  out->resize(n);
  if (n > 0) impl_->ReadInto(begin, n, type.get(), out->data());
}

}  // namespace evit::formats
