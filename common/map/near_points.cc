#include "common/map/near_points.h"

#include <algorithm>
#include <array>

#include "common/simd/lanes.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace evit {
namespace {

struct Columns {
  float *dx, *dy, *dz, *count;
};
using Find = std::size_t (*)(const Surroundings&, const float*, float, std::int32_t, const Columns&);

std::size_t FindOneByOne(const Surroundings& around, const float* p, float radius2, std::int32_t self,
                         const Columns& out) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < around.size(); ++k) {
    const float dx = around.x[k] - p[0], dy = around.y[k] - p[1], dz = around.z[k] - p[2];
    out.dx[n] = dx, out.dy[n] = dy, out.dz[n] = dz;
    out.count[n] = around.index[k] == self ? 0 : around.count[k];
    n += dx * dx + (dy * dy + dz * dz) <= radius2 ? 1 : 0;  // no branch: hard to predict
  }
  return n;
}

#if defined(__x86_64__)

// For each mask of eight lanes, the places of those that are set, then whatever.
std::array<std::array<std::int32_t, 8>, 256> MakeOrders() {
  std::array<std::array<std::int32_t, 8>, 256> orders{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    std::size_t n = 0;
    for (int lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1U) != 0) orders[mask][n++] = lane;
    }
  }
  return orders;
}

// No compiler makes this of the loop above: lanes move to the front.
__attribute__((target("avx2"))) std::size_t FindEightAtOnce(const Surroundings& around, const float* p,
                                                            float radius2, std::int32_t self,
                                                            const Columns& out) {
  static const std::array<std::array<std::int32_t, 8>, 256> orders = MakeOrders();
  const __m256 px = _mm256_set1_ps(p[0]), py = _mm256_set1_ps(p[1]), pz = _mm256_set1_ps(p[2]);
  const __m256 limit = _mm256_set1_ps(radius2);
  const __m256i own = _mm256_set1_epi32(self);
  std::size_t n = 0;
  for (std::size_t k = 0; k < around.size(); k += 8) {
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(&around.x[k]), px);
    const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(&around.y[k]), py);
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(&around.z[k]), pz);
    const __m256 d2 =
        _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_add_ps(_mm256_mul_ps(dy, dy), _mm256_mul_ps(dz, dz)));
    const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(d2, limit, _CMP_LE_OQ)));
    const __m256i index = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(&around.index[k]));
    const __m256 count = _mm256_andnot_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(index, own)),
                                          _mm256_loadu_ps(&around.count[k]));
    const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(orders[mask].data()));
    _mm256_storeu_ps(out.dx + n, _mm256_permutevar8x32_ps(dx, order));
    _mm256_storeu_ps(out.dy + n, _mm256_permutevar8x32_ps(dy, order));
    _mm256_storeu_ps(out.dz + n, _mm256_permutevar8x32_ps(dz, order));
    _mm256_storeu_ps(out.count + n, _mm256_permutevar8x32_ps(count, order));
    n += static_cast<std::size_t>(__builtin_popcount(mask));
  }
  return n;
}

Find Fastest() { return __builtin_cpu_supports("avx2") != 0 ? FindEightAtOnce : FindOneByOne; }

#else

Find Fastest() { return FindOneByOne; }

#endif

}  // namespace

void Surroundings::Clear() {
  for (std::vector<float>* v : {&x, &y, &z, &count}) v->clear();
  index.clear();
}

void Surroundings::Add(float px, float py, float pz, float stands_for, std::int32_t its_index) {
  x.push_back(px), y.push_back(py), z.push_back(pz);
  count.push_back(stands_for);
  index.push_back(its_index);
}

void FindNear(const Surroundings& around, const float* p, float radius2, std::int32_t self,
              NearPoints* near) {
  static const Find find = Fastest();
  const std::size_t most = around.size() + kLanes;  // eight are written where one is found
  for (std::vector<float>* v : {&near->dx, &near->dy, &near->dz, &near->count}) {
    if (v->size() < most) v->resize(most);
  }
  const Columns out{near->dx.data(), near->dy.data(), near->dz.data(), near->count.data()};
  const std::size_t n = find(around, p, radius2, self, out);
  near->room = (n + kLanes - 1) / kLanes * kLanes;
  for (float* column : {out.dx, out.dy, out.dz, out.count}) std::fill(column + n, column + near->room, 0.0F);
}

}  // namespace evit
