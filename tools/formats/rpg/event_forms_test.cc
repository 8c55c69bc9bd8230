// Tables of events as other programs write them.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "tests/helpers/rpg_folder.h"

namespace evit::formats {
namespace {

// What other programs write; each must give the same events.
TEST_F(RpgImportTest, EventsInEveryFormThatHasOneMeaning) {
  constexpr int kEvents = 4000;
  const auto write = [&](const std::string& head, const std::string& end,
                         const std::function<std::string(Utime, int, int, int)>& row) {
    std::ofstream out(In("events.txt"), std::ios::binary);
    out << head;
    for (int k = 0; k < kEvents; ++k)
      out << row(made_.events.t[k], made_.events.x[k], made_.events.y[k], made_.events.p[k]) << end;
  };
  const auto text = [](const char* format, auto... values) {
    char row[200];
    std::snprintf(row, sizeof row, format, values...);
    return std::string(row);
  };
  const auto seconds = [](Utime t) { return 1e-6 * static_cast<double>(t); };
  const std::vector<std::function<void()>> forms = {
      [&] {
        write("240 180\n", "\n",
              [&](Utime t, int x, int y, int p) { return text("%.6f %d %d %d", seconds(t), x, y, p); });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%.18e %.18e %.18e %.18e", seconds(t), 1.0 * x, 1.0 * y, 1.0 * p);
        });
      },
      [&] {
        write("\xEF\xBB\xBFt,x,y,p\r\n", "\r\n",
              [&](Utime t, int x, int y, int p) { return text("%.6f,%d.0,%d.0,%d", seconds(t), x, y, p); });
      },
      [&] {
        write("# t x y p\r", "\r", [&](Utime t, int x, int y, int p) {
          return text("%.6f;%d;%d;%s", seconds(t), x, y, p ? "True" : "False");
        });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%.6f %d %d %d", seconds(t), x, y, 2 * p - 1);
        });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld %d %d %d", static_cast<long long>(t), x, y, p);
        });
      },
      [&] {
        write("ts.secs,ts.nsecs,x,y,polarity\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld,%lld,%d,%d,%d", static_cast<long long>(t / 1'000'000),
                      static_cast<long long>(t % 1'000'000 * 1000), x, y, p);
        });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%d,%d,%d,%lld", x, y, p, static_cast<long long>(t));
        });
      },
      [&] {
        write(",x,y,polarity,timestamp\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("7,%d,%d,%d,%lld", x, y, p, static_cast<long long>(t));
        });
      },
      [&] {
        write("", "\n",
              [&](Utime t, int x, int y, int p) { return text("%d %d %.6f %d", x, y, seconds(t), p); });
      },
      [&] {
        write("x y t[ns] p\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%d %d %lld %d", x, y, 1000 * static_cast<long long>(t), p);
        });
      },
      [&] {
        write("", "\n",
              [&](Utime t, int x, int y, int p) { return text("%.3f %d %d %d", 1e3 * seconds(t), x, y, p); });
      },
      [&] {
        write("secs,nsecs,x,y,p\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld,%lld,%d,%d,%s", static_cast<long long>(t / 1'000'000),
                      static_cast<long long>(t % 1'000'000 * 1000), x, y, p ? "pos" : "neg");
        });
      },
      [&] {
        write("% recorded with\n% geometry 240x180\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%d %d %d %lld", p, x, y, static_cast<long long>(t));
        });
      },
      [&] {
        write("t (\xC2\xB5s),x,y,p\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld,%d,%d,%s", static_cast<long long>(t), x, y, p ? "+" : "-");
        });
      },
  };
  made_.events.t.resize(kEvents), made_.events.x.resize(kEvents), made_.events.y.resize(kEvents),
      made_.events.p.resize(kEvents);
  for (std::size_t k = 0; k < forms.size(); ++k) {
    SCOPED_TRACE(k);
    forms[k]();
    Import();
    ExpectSame(ReadImported(job_.out).events, made_.events);
  }
}

}  // namespace
}  // namespace evit::formats
