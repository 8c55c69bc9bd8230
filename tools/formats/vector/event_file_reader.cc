#include "tools/formats/vector/event_file_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "tools/formats/import/polarity_code.h"
#include "tools/formats/vector/h5_column.h"
#include "tools/formats/vector/lzf_filter.h"
#include "tools/formats/vector/zstd_filter.h"

namespace evit::formats {
namespace {

constexpr char kLayout[] = "VECtor's layout: events/{x,y,p,t}, t_offset, ms_to_idx";
constexpr char kFractionalPixel[] =
    "a pixel with a fraction: undistorted coordinates? The tracker needs the sensor's own pixels";
constexpr std::size_t kProbe = 10'000;  // stamps that tell their unit
constexpr double kNever = 4e15;         // us: beyond any date

// Microseconds of one, for floats: whole numbers are us (ns where they are a date in ns), others s.
double MicrosPerUnit(const std::vector<double>& stamps) {
  double largest = 0;
  bool whole = true;
  for (const double t : stamps) {
    if (!std::isfinite(t)) continue;
    largest = std::max(largest, std::abs(t));
    whole = whole && t == std::floor(t);
  }
  if (largest >= 1e17) return 1e-3;
  if (largest >= 1e14) return 1;
  return whole && largest > 0 ? 1 : 1e6;
}

}  // namespace

struct EventFileReader::Impl {
  std::string path;
  H5Handle file;
  std::unique_ptr<H5Column> x, y, p, t;
  std::size_t at = 0;
  double micros_per_unit = 1;
  std::int64_t t_offset = 0;
  Utime last = 0, wrapped = 0;  // of t as it stands; what its wraps add up to
  std::int64_t n_impossible = 0;
  PolarityCode polarity;

  [[noreturn]] void Fail(const std::string& what) const { throw std::runtime_error(path + ": " + what); }

  std::unique_ptr<H5Column> Open(const char* name) const {
    return std::make_unique<H5Column>(file.get(), path, name, kLayout);
  }

  void ReadOffset() {
    if (H5Lexists(file.get(), "t_offset", H5P_DEFAULT) <= 0) return;
    const H5Column offset(file.get(), path, "t_offset", kLayout);
    std::vector<double> value;
    if (offset.size() != 1)
      offset.Fail("holds " + std::to_string(offset.size()) + " numbers; expected one (us)");
    if (offset.number_class() == H5Column::Class::kInteger && micros_per_unit == 1) {
      std::vector<std::int64_t> whole;
      offset.Read(0, 1, "", &whole);
      t_offset = whole[0];
      if (std::abs(static_cast<double>(t_offset)) >= 1e17) t_offset /= 1000;  // ns
      return;
    }
    offset.Read(0, 1, &value);
    double scale = micros_per_unit;
    if (std::abs(value[0]) >= 1e14) scale = std::abs(value[0]) >= 1e17 ? 1e-3 : 1;  // dates in us or ns
    if (std::abs(value[0]) >= 1e9 && std::abs(value[0]) < 1e10) scale = 1e6;        // dates in s
    if (!(std::abs(value[0] * scale) < kNever)) offset.Fail("is no time");
    t_offset = std::llround(value[0] * scale);
  }

  void FindUnit() {
    std::vector<double> probe;
    t->Read(0, std::min(kProbe, t->size()), &probe);
    if (t->number_class() == H5Column::Class::kInteger) {
      const bool nanoseconds = !probe.empty() && std::abs(probe.front()) >= 1e17;
      micros_per_unit = nanoseconds ? 1e-3 : 1;
      return;
    }
    micros_per_unit = MicrosPerUnit(probe);
    if (t->bytes() < 8 && probe.size() > 1000 && probe.front() == probe.back())
      t->Fail(
          "holds 32-bit floats that say the same time for all events: too coarse for a date; write float64");
  }

  void ReadStamps(std::size_t n, std::vector<Utime>* out) {
    if (t->number_class() == H5Column::Class::kFloat || micros_per_unit != 1) {
      std::vector<double> values;
      t->Read(at, n, &values);
      out->resize(n);
      for (std::size_t k = 0; k < n; ++k) {
        const double micros = values[k] * micros_per_unit;
        if (!(std::abs(micros) < kNever)) t->Fail("entry " + std::to_string(at + k) + " is no time");
        (*out)[k] = std::llround(micros) + t_offset;
      }
      return;
    }
    t->Read(at, n, "", out);
    constexpr Utime kWrap = Utime{1} << 32;
    for (Utime& stamp : *out) {
      if (stamp < 0 || static_cast<double>(stamp) > kNever)
        t->Fail("holds a number that is no time: " + std::to_string(stamp));
      if (t->bytes() == 4 && stamp < last - kWrap / 2) wrapped += kWrap;
      last = stamp;
      stamp += wrapped + t_offset;
    }
  }
};

EventFileReader::EventFileReader(const std::string& path) : impl_(std::make_unique<Impl>()) {
  RegisterZstdFilter();
  RegisterLzfFilter();
  Impl& r = *impl_;
  r.path = path;
  if (!std::filesystem::exists(path)) r.Fail("there is no such file");
  r.file = H5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!r.file.ok()) r.Fail("is not a complete HDF5 file (truncated or damaged); download it again");
  r.x = r.Open("events/x");
  r.y = r.Open("events/y");
  r.p = r.Open("events/p");
  r.t = r.Open("events/t");
  for (const auto& [column, name] : {std::pair(&r.x, "x"), std::pair(&r.y, "y"), std::pair(&r.p, "p")}) {
    if ((*column)->size() != r.t->size()) {
      r.Fail(std::string("events/") + name + " has " + std::to_string((*column)->size()) +
             " entries, events/t " + std::to_string(r.t->size()) +
             ": the file is damaged; download it again");
    }
  }
  r.FindUnit();
  r.ReadOffset();
}

EventFileReader::~EventFileReader() = default;

std::size_t EventFileReader::size() const { return impl_->t->size(); }

std::int64_t EventFileReader::n_impossible() const { return impl_->n_impossible; }

std::size_t EventFileReader::Read(std::size_t max_events, EventArray* events) {
  Impl& r = *impl_;
  events->clear();
  const std::size_t n = std::min(max_events, size() - r.at);
  if (n == 0) return 0;
  std::vector<std::int64_t> x, y, p;
  std::vector<Utime> t;
  r.x->Read(r.at, n, kFractionalPixel, &x);
  r.y->Read(r.at, n, kFractionalPixel, &y);
  r.p->Read(r.at, n, "a polarity with a fraction", &p);
  r.ReadStamps(n, &t);
  constexpr std::int64_t kLargest = std::numeric_limits<std::uint16_t>::max();
  try {
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint8_t polarity = r.polarity.Read(p[k]);
      if (x[k] < 0 || y[k] < 0 || x[k] > kLargest || y[k] > kLargest) {
        ++r.n_impossible;
        continue;
      }
      events->push_back(t[k], static_cast<std::uint16_t>(x[k]), static_cast<std::uint16_t>(y[k]), polarity);
    }
  } catch (const std::runtime_error& error) {
    r.p->Fail(std::string("cannot be read: ") + error.what());
  }
  r.at += n;
  return n;
}

}  // namespace evit::formats
