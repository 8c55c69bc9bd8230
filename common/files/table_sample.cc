#include "common/files/table_sample.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "common/files/table_reader.h"

namespace evit {
namespace {

// The sign of micro, in UTF-8 (two code points) or Latin-1, as the u that stands for it.
std::string WithoutMicroSign(std::string word) {
  for (const char* sign : {"\xC2\xB5", "\xCE\xBC", "\xB5"}) {
    for (std::size_t at = word.find(sign); at != std::string::npos; at = word.find(sign))
      word.replace(at, std::char_traits<char>::length(sign), "u");
  }
  return word;
}

// A word in lower case, taken apart at everything that is not a letter: "#timestamp[ns]" to "timestamp",
// "ns".
std::vector<std::string> Letters(const std::string& word) {
  std::vector<std::string> parts(1);
  for (const char c : WithoutMicroSign(word)) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      parts.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  return parts;
}

std::optional<TimeUnit> UnitNamed(const std::string& word) {
  for (const auto& [name, unit] :
       {std::pair("s", TimeUnit::kSeconds), std::pair("sec", TimeUnit::kSeconds),
        std::pair("secs", TimeUnit::kSeconds), std::pair("seconds", TimeUnit::kSeconds),
        std::pair("ms", TimeUnit::kMilliseconds), std::pair("msec", TimeUnit::kMilliseconds),
        std::pair("milliseconds", TimeUnit::kMilliseconds), std::pair("us", TimeUnit::kMicroseconds),
        std::pair("usec", TimeUnit::kMicroseconds), std::pair("micros", TimeUnit::kMicroseconds),
        std::pair("microseconds", TimeUnit::kMicroseconds), std::pair("ns", TimeUnit::kNanoseconds),
        std::pair("nsec", TimeUnit::kNanoseconds), std::pair("nanoseconds", TimeUnit::kNanoseconds)}) {
    if (word == name) return unit;
  }
  return {};
}

constexpr double kSeconds[] = {1, 1e-3, 1e-6, 1e-9};  // of each TimeUnit

// What a column of whole numbers looks like.
struct Steps {
  double median = 0;         // of those between different numbers
  bool mostly_none = false;  // more than half of the rows have the number of the row before
};

Steps StepsOf(const std::vector<double>& stamps) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    if (stamps[k] != stamps[k - 1]) steps.push_back(std::abs(stamps[k] - stamps[k - 1]));
  }
  Steps out;
  out.mostly_none = 2 * steps.size() + 1 < stamps.size();
  if (steps.empty()) return out;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  out.median = *middle;
  return out;
}

// How fine the stamps are written.
struct Grain {
  std::size_t decimals = 0;  // most that any has, without zeros at the end
  bool thousands = true;     // all are whole thousands
};

Grain GrainOf(const std::vector<std::string>& words) {
  Grain grain;
  for (const std::string& word : words) {
    const std::size_t point = word.find('.'), last = word.find_last_not_of('0');
    if (word.find_first_of("eE") != std::string::npos) return {99, false};
    if (point != std::string::npos) grain.decimals = std::max(grain.decimals, std::max(last, point) - point);
    const std::string whole = word.substr(0, point);
    grain.thousands &= whole == "0" || (whole.size() > 3 && whole.compare(whole.size() - 3, 3, "000") == 0);
  }
  grain.thousands &= grain.decimals == 0;
  return grain;
}

// Clocks of event cameras count microseconds: written as milliseconds these have three decimals, as
// nanoseconds three zeros. Nothing where the stamps are too few, or the rows too far apart for events.
std::optional<TimeUnit> UnitOfMicroseconds(const std::vector<std::string>& words, const Steps& steps,
                                           double slowest_s) {
  constexpr std::size_t kTelling = 10;
  constexpr double kEvents = 0.01;
  if (words.size() < kTelling || slowest_s > kEvents || steps.mostly_none || steps.median == 0) return {};
  const Grain grain = GrainOf(words);
  if (grain.decimals > 0 && grain.decimals <= 3) return TimeUnit::kMilliseconds;
  if (grain.thousands) return TimeUnit::kNanoseconds;
  return {};
}

}  // namespace

TableSample SampleTable(const std::string& path, const std::string& layout, std::size_t max_rows) {
  TableReader table(path, layout);
  TableSample sample;
  while (sample.rows.size() < max_rows && table.Next()) {
    std::vector<std::string>& row = sample.rows.emplace_back();
    while (table.more()) row.emplace_back(table.Word());
  }
  sample.head = table.head();
  return sample;
}

std::vector<ColumnName> NamedColumns(const std::vector<std::string>& head) {
  std::vector<ColumnName> columns;
  bool in_unit = false;
  for (const std::string& word : head) {
    const std::size_t bracket = in_unit ? 0 : word.find_first_of("[(");
    if (!in_unit && (bracket != 0 || columns.empty())) columns.push_back({word.substr(0, bracket), ""});
    if (bracket == std::string::npos) continue;
    columns.back().unit += word.substr(bracket);
    in_unit = word.find_first_of("])") == std::string::npos;
  }
  return columns;
}

std::optional<TimeUnit> UnitInName(const ColumnName& name) {
  for (const std::string& word : {name.unit, name.name}) {
    for (const std::string& part : Letters(word)) {
      if (const auto unit = UnitNamed(part)) return unit;
    }
  }
  return {};
}

TimeUnit UnitOfStamps(const TableSample& sample, std::size_t column, double slowest_s) {
  const std::vector<ColumnName> names = NamedColumns(sample.head);
  const std::size_t columns = sample.rows.empty() ? 0 : sample.rows.front().size();
  if (column < names.size() && (column == 0 || names.size() == columns)) {
    if (const auto said = UnitInName(names[column])) return *said;
  }
  std::vector<double> stamps;
  std::vector<std::string> words;
  std::optional<TimeUnit> date;
  bool whole = true;
  for (const auto& row : sample.rows) {
    double value = 0;
    if (column >= row.size() || !ParseNumber(row[column], &value) || !std::isfinite(value)) continue;
    if (stamps.empty()) date = UnitOfDate(row[column]);
    whole = whole && value == std::floor(value);
    stamps.push_back(value);
    words.push_back(row[column]);
  }
  const Steps steps = StepsOf(stamps);
  const auto fits = [&](TimeUnit unit) {
    return steps.median * kSeconds[static_cast<int>(unit)] <= slowest_s;
  };
  if (date && (*date == TimeUnit::kSeconds ? !whole || (fits(*date) && !steps.mostly_none) : fits(*date)))
    return *date;
  if (const auto unit = UnitOfMicroseconds(words, steps, slowest_s)) return *unit;
  if (!whole || stamps.size() < 2 || (fits(TimeUnit::kSeconds) && !steps.mostly_none))
    return TimeUnit::kSeconds;
  return steps.median * 1e-6 <= std::min(slowest_s, 0.5) ? TimeUnit::kMicroseconds : TimeUnit::kNanoseconds;
}

}  // namespace evit
