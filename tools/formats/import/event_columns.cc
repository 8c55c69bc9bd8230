#include "tools/formats/import/event_columns.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "common/files/table_reader.h"

namespace evit::formats {
namespace {

using Field = EventColumns::Field;
using Order = std::array<Field, 4>;
constexpr char kLayout[] = "t x y p";
constexpr double kSlowest = 0.01;  // s: events come more often than this

std::string Name(const std::string& word) {  // "t[us]" and "T_us" to "t"
  std::string name;
  for (const char c : word) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) break;
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

// "secs" of "header.stamp.secs", with the point before it; empty: no such end.
std::string LastPart(const std::string& word) {
  const std::size_t point = word.find_last_of("._");
  return point == std::string::npos ? "" : Name(word.substr(point + 1));
}

std::optional<Field> FieldNamed(const std::string& word) {
  const std::string name = Name(word), last = LastPart(word);
  const auto is_any = [](const std::string& text, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return text == n; });
  };
  const auto is = [&](std::initializer_list<const char*> names) { return is_any(name, names); };
  const bool one_column = is({"t", "time", "timestamp"});  // t_nsec: the time, in nanoseconds
  if (!one_column && is_any(last, {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"}))
    return EventColumns::kNanoseconds;
  if (is_any(last, {"sec", "secs", "seconds"})) return EventColumns::kTime;
  if (is({"t", "ts", "time", "timestamp", "stamp", "sec", "secs", "seconds"})) return EventColumns::kTime;
  if (is({"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"})) return EventColumns::kNanoseconds;
  if (is({"x", "u", "col", "column"})) return EventColumns::kX;
  if (is({"y", "v", "row"})) return EventColumns::kY;
  if (is({"p", "pol", "polarity", "sign"})) return EventColumns::kPolarity;
  return {};
}

// By the names, where all four are there.
bool ByHead(const TableSample& sample, EventColumns* columns) {
  const std::size_t n = sample.rows.empty() ? 0 : sample.rows.front().size();
  std::vector<ColumnName> head = NamedColumns(sample.head);
  if (head.size() + 1 == n) head.insert(head.begin(), {"", ""});  // an index column without a name (pandas)
  if (head.size() != n || n > columns->field.size()) return false;
  std::array<int, 5> found{};
  for (std::size_t k = 0; k < n; ++k) {
    columns->field[k] = FieldNamed(head[k].name).value_or(EventColumns::kIgnored);
    if (columns->field[k] != EventColumns::kIgnored) ++found[columns->field[k]];
  }
  columns->n = n;
  return found == std::array<int, 5>{1, 1, 1, 1, 0} || found == std::array<int, 5>{1, 1, 1, 1, 1};
}

bool IsPolarity(const std::string& word) {
  double value = 0;
  if (!ParseNumber(word, &value))
    return !word.empty() &&
           (std::isalpha(static_cast<unsigned char>(word[0])) != 0 || word == "+" || word == "-");
  return value == 0 || value == 1 || value == -1;
}

bool IsPixel(const std::string& word) {
  double value = 0;
  return ParseNumber(word, &value) && value == std::floor(value) && std::abs(value) < 8192;
}

// How many rows have an earlier time than the row before, if the rows can be of this order at all.
std::optional<std::size_t> Backward(const TableSample& sample, const Order& order) {
  double last = -INFINITY;
  std::size_t backward = 0;
  for (const auto& row : sample.rows) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (order[k] == EventColumns::kPolarity && !IsPolarity(row[k])) return {};
      if ((order[k] == EventColumns::kX || order[k] == EventColumns::kY) && !IsPixel(row[k])) return {};
      double t = 0;
      if (order[k] != EventColumns::kTime) continue;
      if (!ParseNumber(row[k], &t)) return {};
      backward += t < last ? 1 : 0;
      last = t;
    }
  }
  if (3 * backward > sample.rows.size()) return {};
  return backward;
}

// The order that rows of four can have in which time goes back least; of equals, the more usual one. A row's
// number is never left of its column's.
std::optional<Order> OrderOf(const TableSample& sample) {
  constexpr Field t = EventColumns::kTime, x = EventColumns::kX, y = EventColumns::kY,
                  p = EventColumns::kPolarity;
  if (sample.rows.empty() || sample.rows.front().size() != 4) return {};
  constexpr std::size_t kUsual = 3, kTelling = 10;  // orders; rows: fewer would fit any order
  std::optional<Order> best;
  std::size_t least = 0, tried = 0;
  for (const Order& order : {Order{t, x, y, p},
                             {x, y, p, t},
                             {x, y, t, p},
                             {t, p, x, y},
                             {p, x, y, t},
                             {p, t, x, y},
                             {x, t, y, p},
                             {x, p, y, t},
                             {t, x, p, y},
                             {x, t, p, y},
                             {x, p, t, y},
                             {p, x, t, y}}) {
    if (++tried > kUsual && sample.rows.size() < kTelling) break;
    const std::optional<std::size_t> backward = Backward(sample, order);
    if (!backward || (best && *backward >= least)) continue;
    best = order;
    least = *backward;
  }
  return best;
}

// Takes a first row "width height" away.
std::optional<std::pair<int, int>> TakeSize(TableSample* sample) {
  double width = 0, height = 0;
  if (sample->rows.size() < 2 || sample->rows.front().size() != 2) return {};
  const bool numbers = ParseNumber(sample->rows[0][0], &width) && ParseNumber(sample->rows[0][1], &height);
  if (!numbers || !(width >= 1 && height >= 1 && width <= 8192 && height <= 8192)) return {};
  sample->rows.erase(sample->rows.begin());
  return std::pair(static_cast<int>(width), static_cast<int>(height));
}

}  // namespace

bool HoldsEvents(TableSample sample) {
  TakeSize(&sample);
  EventColumns columns;
  if (sample.rows.empty()) return false;
  if (ByHead(sample, &columns)) return true;
  double value = 0;
  const std::vector<std::string>& first = sample.rows.front();
  return first.size() == 4 &&
         std::all_of(
             first.begin(), first.end(),
             [&](const std::string& word) { return ParseNumber(word, &value) || IsPolarity(word); }) &&
         ParseNumber(first[1], &value);
}

bool NamesEvents(const std::vector<std::string>& head) {
  std::array<bool, 5> found{};
  for (const ColumnName& column : NamedColumns(head)) {
    if (const auto field = FieldNamed(column.name)) found[*field] = true;
  }
  return found[EventColumns::kTime] && found[EventColumns::kX] && found[EventColumns::kY] &&
         found[EventColumns::kPolarity];
}

bool FitsEvents(const TableSample& sample) { return OrderOf(sample).has_value(); }

EventColumns FindEventColumns(const std::string& path) {
  return FindEventColumns(SampleTable(path, kLayout));
}

EventColumns FindEventColumns(TableSample sample) {
  EventColumns columns;
  columns.size = TakeSize(&sample);
  // The reader itself says what is wrong with a row.
  sample.rows.erase(std::remove_if(sample.rows.begin(), sample.rows.end(),
                                   [&](const auto& row) { return row.size() != sample.rows.front().size(); }),
                    sample.rows.end());
  if (sample.rows.empty()) return columns;
  if (!ByHead(sample, &columns)) {
    columns.field = EventColumns().field;
    columns.n = 4;
    if (const auto order = OrderOf(sample)) std::copy(order->begin(), order->end(), columns.field.begin());
  }
  const auto end = columns.field.begin() + static_cast<std::ptrdiff_t>(columns.n);
  if (std::find(columns.field.begin(), end, EventColumns::kNanoseconds) != end)
    return columns;  // beside whole seconds
  const auto time = std::find(columns.field.begin(), end, EventColumns::kTime);
  columns.unit = UnitOfStamps(sample, static_cast<std::size_t>(time - columns.field.begin()), kSlowest);
  return columns;
}

}  // namespace evit::formats
