#include "tools/formats/hdf5/h5_events.h"

#include <algorithm>
#include <cmath>

namespace evit::formats {
namespace {

constexpr std::size_t kPiece = 1 << 17, kLargestPiece = 1 << 22;  // events
constexpr std::uint16_t kOutside = 65535;
// No date in seconds is so large, and no date in microseconds so small.
constexpr double kSmallestDateInMicros = 1e14;

}  // namespace

H5EventReader::H5EventReader(const H5File& file, const H5EventLayout& layout)
    : kind_(layout.kind), t_(file.Open(layout.t)), size_(t_.rows()) {
  if (kind_ == H5EventLayout::Kind::kColumns) {
    x_ = file.Open(layout.x);
    y_ = file.Open(layout.y);
    p_ = file.Open(layout.p);
    for (const H5Rows* rows : {&*x_, &*y_, &*p_}) {
      if (rows->rows() != size_ || rows->columns() != 1)
        rows->Fail("has " + std::to_string(rows->rows()) + " entries, " + t_.name() + " " +
                   std::to_string(size_) + ": the file is damaged; download it again");
    }
  }
  if (!layout.offset.empty()) {
    const H5Rows offset = file.Open(layout.offset);
    if (!offset.is_integer() || offset.rows() != 1 || offset.columns() != 1)
      offset.Fail("expected one whole number (us)");
    offset_ = offset.ReadAll<std::int64_t>().front();
  }
  // Whole chunks, so that none is decompressed twice.
  const std::size_t chunk = std::min(t_.chunk_rows(), kLargestPiece);
  piece_ = std::max(kPiece / chunk, std::size_t{1}) * chunk;
  if (kind_ == H5EventLayout::Kind::kRows) {
    seconds_ = true;
  } else if (kind_ == H5EventLayout::Kind::kColumns && !t_.is_integer() && size_ > 0) {
    // Numbers with fractions are seconds; whole ones may be microseconds stored as floats.
    std::vector<double> first, last;
    t_.Read(0, std::min<std::size_t>(size_, 1000), &first);
    t_.Read(size_ - 1, 1, &last);
    const bool whole = std::all_of(first.begin(), first.end(), [](double t) { return t == std::floor(t); });
    seconds_ =
        std::abs(first.front()) < kSmallestDateInMicros && !(whole && last.front() - first.front() > 1e5);
    if (t_.bytes() < 8 && last.front() > (seconds_ ? 8.0 : 8e6))
      t_.Fail(
          "holds stamps as 32-bit floats, which do not resolve a microsecond after 8 s: write them as int64 "
          "or float64");
  }
}

std::uint16_t H5EventReader::Pixel(const H5Rows& rows, double value) const {
  if (value != std::floor(value))
    rows.Fail("event " + std::to_string(at_) + " ff.: pixel " + std::to_string(value) +
              " is no whole number");
  return value >= 0 && value < kOutside ? static_cast<std::uint16_t>(value) : kOutside;
}

// -1 stored without sign is 255; 0 and -1 in one file would be two words for darker, or three polarities.
std::uint8_t H5EventReader::Polarity(const H5Rows& rows, double value) {
  if (value == 1) return 1;
  const bool minus = value == -1 || (value == 255 && rows.is_integer() && !rows.is_signed());
  if (minus) minus_seen_ = true;
  if (value == 0) zero_seen_ = true;
  if ((!minus && value != 0) || (minus_seen_ && zero_seen_)) {
    rows.Fail("event " + std::to_string(at_) + " ff.: polarity " + std::to_string(static_cast<int>(value)) +
              (minus_seen_ && zero_seen_ ? " beside others" : "") + "; expected 0 and 1, or -1 and 1");
  }
  return 0;
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
  } else {
    t_.Read(at_, n, &doubles_);
    out->resize(n);
    const double scale = seconds_ ? 1e6 : 1;
    for (std::size_t k = 0; k < n; ++k) {
      if (!(std::abs(doubles_[k]) * scale < 9e18))
        t_.Fail("event " + std::to_string(at_ + k) + ": the stamp is no number");
      (*out)[k] = std::llround(doubles_[k] * scale);
    }
  }
  if (offset_ != 0) {
    for (Utime& t : *out) t += offset_;
  }
}

void H5EventReader::ReadPolarities(std::size_t n, std::vector<std::uint8_t>* out) {
  if (p_->is_integer() && !p_->is_signed() && p_->bytes() == 1) {
    p_->Read(at_, n, out);
    std::uint8_t largest = 0, smallest = 1;
    for (const std::uint8_t p : *out) largest = std::max(largest, p);
    for (const std::uint8_t p : *out) smallest = std::min(smallest, p);
    if (largest <= 1 && !minus_seen_) {
      zero_seen_ = zero_seen_ || smallest == 0;
      return;
    }
  }
  p_->Read(at_, n, &doubles_);
  out->resize(n);
  for (std::size_t k = 0; k < n; ++k) (*out)[k] = Polarity(*p_, doubles_[k]);
}

void H5EventReader::ReadRows(std::size_t n, EventArray* events) {
  t_.Read(at_, n, &doubles_);
  for (std::size_t k = 0; k < n; ++k) {
    const double* row = doubles_.data() + 4 * k;
    if (!(std::abs(row[2]) < 9e12)) t_.Fail("event " + std::to_string(at_ + k) + ": the stamp is no number");
    events->push_back(std::llround(1e6 * row[2]) + offset_, Pixel(t_, row[0]), Pixel(t_, row[1]),
                      Polarity(t_, row[3]));
  }
}

void H5EventReader::ReadCompounds(std::size_t n, EventArray* events) {
  std::vector<H5Event> compounds;
  H5File::ReadEvents(t_, at_, n, &compounds);
  for (const H5Event& e : compounds) events->push_back(e.t, e.x, e.y, Polarity(t_, e.p));
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
      ReadPixels(*x_, n, &events->x);
      ReadPixels(*y_, n, &events->y);
      ReadTimes(n, &events->t);
      ReadPolarities(n, &events->p);
      break;
  }
  at_ += n;
  return true;
}

}  // namespace evit::formats
