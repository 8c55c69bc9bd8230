#include "tools/formats/hdf5/h5_events.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/formats/hdf5/h5_sample.h"
#include "tools/formats/import/micros_per_unit.h"

namespace evit::formats {
namespace {

constexpr std::size_t kPiece = 1 << 17, kLargestPiece = 1 << 22;  // events
constexpr std::uint16_t kOutside = 65535;
constexpr double kFloatResolution = 1.2e-7;  // of a 32-bit float

// A stamp of 32 bits may be too coarse: then many events share one.
void RequireResolution(const H5Rows& t, double micros_per_unit) {
  if (t.is_integer() || t.bytes() >= 8 || t.rows() == 0 || t.columns() != 1) return;
  std::vector<double> last;
  t.Read(t.rows() - 1, 1, &last);
  if (std::abs(last.front()) * micros_per_unit * kFloatResolution < 1) return;
  t.Fail(
      "holds stamps as 32-bit floats, which do not resolve a microsecond after 8 s: write them as int64 or "
      "float64");
}

// A file may promise any number of events; what it never stored reads as zeros.
void RequireStored(const H5Rows& t) {
  constexpr double kDensest = 5000;  // times as many bytes as stored; stamps increase, and pack far less
  const std::optional<std::uint64_t> stored = t.stored();
  if (!stored || static_cast<double>(t.rows()) * static_cast<double>(t.bytes()) <=
                     kDensest * static_cast<double>(*stored))
    return;
  t.Fail("has " + std::to_string(t.rows()) + " entries by its shape, but the file stores only " +
         std::to_string(*stored) + " bytes of them: it was not written to its end");
}

}  // namespace

H5EventReader::H5EventReader(const H5File& file, const H5EventLayout& layout)
    : kind_(layout.kind), t_(file.Open(layout.t)), size_(t_.rows()) {
  if (kind_ == H5EventLayout::Kind::kColumns) {
    columns_ = Columns{file.Open(layout.x), file.Open(layout.y), file.Open(layout.p)};
    for (const H5Rows* rows : {&columns_->x, &columns_->y, &columns_->p}) {
      if (rows->rows() != size_ || rows->columns() != 1)
        rows->Fail("has " + std::to_string(rows->rows()) + " entries, " + t_.name() + " " +
                   std::to_string(size_) + ": the file is damaged; download it again");
    }
  }
  RequireStored(t_);
  // Whole chunks, so that none is decompressed twice.
  const std::size_t chunk = std::min(t_.chunk_rows(), kLargestPiece);
  piece_ = std::max(kPiece / chunk, std::size_t{1}) * chunk;
  if (size_ == 0) return;
  if (kind_ == H5EventLayout::Kind::kColumns) {
    order_ = FindEventColumns(SampleColumns({&t_, &columns_->x, &columns_->y, &columns_->p}, "t x y p"));
  } else if (kind_ == H5EventLayout::Kind::kRows) {
    order_ = FindEventColumns(SampleColumns({&t_}, ""));
  } else {
    const H5Rows t = file.Open(layout.t + ":t"), x = file.Open(layout.t + ":x"),
                 y = file.Open(layout.t + ":y"), p = file.Open(layout.t + ":p");
    order_ = FindEventColumns(SampleColumns({&t, &x, &y, &p}, "t x y p"));
  }
  RequireResolution(t_, MicrosPerUnit(order_.unit));
  std::optional<H5Rows> offset;
  if (!layout.offset.empty()) offset = file.Open(layout.offset);
  stamps_.emplace(order_.unit, offset ? &*offset : nullptr);
}

std::uint16_t H5EventReader::Pixel(const H5Rows& rows, double value) const {
  if (value != std::floor(value))
    rows.Fail("event " + std::to_string(at_) + " ff.: pixel " + std::to_string(value) +
              " is not a whole number: undistorted coordinates? The tracker needs the sensor's own pixels");
  return value >= 0 && value < kOutside ? static_cast<std::uint16_t>(value) : kOutside;
}

std::uint8_t H5EventReader::Polarity(const H5Rows& rows, double value) {
  constexpr double kMinusOne = 18446744073709551615.0;  // as 64 bits without sign keep it
  if (value != std::floor(value) || !(std::abs(value) <= kMinusOne))
    rows.Fail("event " + std::to_string(at_) + " ff.: the polarity " + std::to_string(value) +
              " has a fraction; expected 0 and 1, or -1 and 1");
  try {
    return polarity_.Read(std::abs(value) >= 9e18 ? -1 : static_cast<std::int64_t>(value));
  } catch (const std::runtime_error& error) {
    rows.Fail("event " + std::to_string(at_) + " ff.: " + error.what());
  }
}

void H5EventReader::ReadPixels(const H5Rows& rows, std::size_t n, std::vector<std::uint16_t>* out) {
  if (rows.is_integer() && !rows.is_signed() && rows.bytes() <= 2) {
    rows.Read(at_, n, out);
    return;
  }
  out->resize(n);
  rows.Read(at_, n, &doubles_);
  for (std::size_t k = 0; k < n; ++k) (*out)[k] = Pixel(rows, doubles_[k]);
}

void H5EventReader::ReadTimes(std::size_t n, std::vector<Utime>* out) {
  if (t_.is_integer()) {
    t_.Read(at_, n, out);
    stamps_->FromIntegers(out);
    return;
  }
  t_.Read(at_, n, &doubles_);
  out->resize(n);
  for (std::size_t k = 0; k < n; ++k) (*out)[k] = stamps_->FromDouble(doubles_[k]);
}

void H5EventReader::ReadPolarities(const H5Rows& rows, std::size_t n, std::vector<std::uint8_t>* out) {
  if (rows.is_integer() && rows.bytes() == 1 && !rows.is_signed()) {
    rows.Read(at_, n, out);
    const auto [smallest, largest] = std::minmax_element(out->begin(), out->end());
    if (*largest <= 1) {
      Polarity(rows, *smallest);
      return;
    }
  }
  rows.Read(at_, n, &doubles_);
  out->resize(n);
  for (std::size_t k = 0; k < n; ++k) (*out)[k] = Polarity(rows, doubles_[k]);
}

void H5EventReader::ReadRows(std::size_t n, EventArray* events) {
  t_.Read(at_, n, &doubles_);
  std::size_t which[4] = {};
  for (std::size_t k = 0; k < 4; ++k) which[order_.field[k]] = k;
  for (std::size_t k = 0; k < n; ++k) {
    const double* row = doubles_.data() + 4 * k;
    events->push_back(stamps_->FromDouble(row[which[EventColumns::kTime]]),
                      Pixel(t_, row[which[EventColumns::kX]]), Pixel(t_, row[which[EventColumns::kY]]),
                      Polarity(t_, row[which[EventColumns::kPolarity]]));
  }
}

void H5EventReader::ReadCompounds(std::size_t n, EventArray* events) {
  std::vector<H5Event> compounds;
  t_.ReadEvents(at_, n, &compounds);
  for (const H5Event& e : compounds) events->push_back(e.t, e.x, e.y, Polarity(t_, e.p));
  stamps_->FromIntegers(&events->t);
}

void H5EventReader::DropUntimed(EventArray* events) {
  if (std::find(events->t.begin(), events->t.end(), H5Stamps::kNoTime) == events->t.end()) return;
  EventArray kept;
  for (std::size_t k = 0; k < events->size(); ++k) {
    if (events->t[k] == H5Stamps::kNoTime) {
      ++n_invalid_;
    } else {
      kept.push_back(events->t[k], events->x[k], events->y[k], events->p[k]);
    }
  }
  *events = std::move(kept);
}

bool H5EventReader::Read(EventArray* events) {
  events->clear();
  const std::size_t n = std::min(piece_, size_ - at_);
  if (n == 0) return false;
  switch (kind_) {
    case H5EventLayout::Kind::kRows:
      ReadRows(n, events);
      break;
    case H5EventLayout::Kind::kCompound:
      ReadCompounds(n, events);
      break;
    case H5EventLayout::Kind::kColumns:
      ReadPixels(columns_->x, n, &events->x);
      ReadPixels(columns_->y, n, &events->y);
      ReadTimes(n, &events->t);
      ReadPolarities(columns_->p, n, &events->p);
      break;
  }
  DropUntimed(events);
  at_ += n;
  return true;
}

}  // namespace evit::formats
