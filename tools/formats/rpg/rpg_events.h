#pragma once

#include <string>

#include "common/files/table_reader.h"
#include "tools/formats/import/event_columns.h"
#include "tools/formats/import/event_filter.h"
#include "tools/formats/import/event_source.h"

namespace evit::formats {

/// RPG's events.txt: `t x y p` (s, pixels, 1 brighter or 0 darker), and what others write so: the columns in
/// the order that their names or their values tell (x y p t, x y t p), stamps in us or ns, polarity -1/1 or
/// True/False, a first line "width height".
class RpgEvents : public EventSource {
 public:
  RpgEvents(const std::string& path, int width, int height);

  bool Read(EventArray* events) override;
  double share() const override { return lines_.share(); }
  std::string name() const override { return path_; }
  DropCounts dropped() const override;

 private:
  std::uint8_t ReadPolarity();

  std::string path_;
  TableReader lines_;
  EventFilter filter_;
  EventColumns columns_;
  bool cut_off_;
};

}  // namespace evit::formats
