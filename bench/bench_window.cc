// The sliding window's solve, against one automatically differentiated Ceres block for each point.
#include <ceres/ceres.h>
#include <ceres/cubic_interpolation.h>

#include <random>

#include "bench/counters.h"
#include "common/tracking/ceres_factors.h"
#include "common/tracking/pose_manifold.h"
#include "common/tracking/sliding_window.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit::bench {
namespace {

constexpr double kGravity = 9.81;
const ImuNoise kNoise{7e-4, 1.3e-3, 7e-6, 6e-5};

WindowOptions Options(int size) {
  WindowOptions o;
  o.size = size;
  o.image_sigma = 50;
  o.max_iterations = 50;
  return o;
}

AlignmentSettings Alignment() {
  AlignmentSettings settings = synthetic::Alignment();
  settings.image_sigma = 50;
  settings.kernel.scale = 80.0 / 50;
  return settings;
}

// Keyframes 20 ms apart in a synthetic room, each some millimetres and milliradians from the truth, the
// newest, as predicted, a centimetre.
std::deque<WindowNode> Nodes(int n, int points) {
  const synthetic::Motion motion;
  const AlignmentSettings settings = Alignment();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::deque<WindowNode> nodes;
  for (int k = 0; k < n; ++k) {
    WindowNode node;
    node.t = 1'000'000 + Utime{20'000} * k;
    node.seq = k;
    node.state = motion.State(ToSeconds(node.t));
    std::vector<Eigen::Vector3f> room = synthetic::RoomPoints();
    node.field =
        std::make_shared<SurfaceField>(synthetic::DrawSurface(settings, room, node.state.T_map_body), 1);
    std::shuffle(room.begin(), room.end(), random);
    room.resize(static_cast<std::size_t>(points));
    node.points = room;
    Eigen::Matrix<double, 6, 1> d;
    for (int i = 0; i < 6; ++i) d[i] = (k + 1 == n ? 0.005 : 0.002) * normal(random);
    node.state.T_map_body = node.state.T_map_body.Plus(d);
    if (k > 0) {
      node.imu =
          std::make_shared<Preintegration>(motion.Samples(nodes.back().t, node.t, {}), ImuBias{}, kNoise);
    }
    nodes.push_back(node);
  }
  return nodes;
}

StatePrior Prior(const BodyState& mean) {
  StatePrior prior;
  prior.mean = mean;
  prior.information.diagonal() << Eigen::Matrix<double, 6, 1>::Constant(1e4),
      Eigen::Matrix<double, 9, 1>::Constant(1e2);
  return prior;
}

void Ours(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0)), points = static_cast<int>(state.range(1));
  const std::deque<WindowNode> nodes = Nodes(n, points);
  SlidingWindow window(Alignment(), kGravity, Options(n));
  double iterations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    window.Start(nodes, Prior(nodes.front().state));
    state.ResumeTiming();
    iterations = window.Solve().iterations;
  }
  const double error =
      (window.nodes().back().state.T_map_body.p - synthetic::Motion().Position(ToSeconds(nodes.back().t)))
          .norm();
  state.counters["iterations"] = iterations;
  state.counters["error_mm"] = 1e3 * error;
  PerCall(state, n == 6 && points == 1000 ? 6e-3 : 0, 0);
}
BENCHMARK(Ours)->Name("Window solve/ours")->Args({6, 1000})->Unit(benchmark::kMillisecond);
BENCHMARK(Ours)
    ->Name("Scaling, window")
    ->ArgNames({"keyframes", "points"})
    ->ArgsProduct({{2, 3, 5, 8, 12}, {1000}})
    ->ArgsProduct({{5}, {250, 500, 1000, 2000, 3500}})
    ->Unit(benchmark::kMillisecond);

struct PointResidual {
  using Grid = ceres::Grid2D<std::uint8_t>;
  const AlignmentSettings* settings;
  const ceres::BiCubicInterpolator<Grid>* field;
  Eigen::Vector3d point;

  template <typename T>
  bool operator()(const T* pose, T* residual) const {
    const Eigen::Quaternion<T> q(pose[6], pose[3], pose[4], pose[5]);
    const Eigen::Matrix<T, 3, 1> p(pose[0], pose[1], pose[2]);
    const Eigen::Matrix<T, 3, 1> body = q.conjugate() * (point.cast<T>() - p);
    const Eigen::Matrix<T, 3, 1> c =
        settings->T_camera_body.q.cast<T>() * body + settings->T_camera_body.p.cast<T>();
    const Camera& camera = settings->camera();
    const auto& d = camera.distortion;
    const T x = c.x() / c.z(), y = c.y() / c.z(), r2 = x * x + y * y;
    const T radial = T(1) + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
    const T u = camera.fx * (x * radial + 2 * d[2] * x * y + d[3] * (r2 + T(2) * x * x)) + camera.cx;
    const T v = camera.fy * (y * radial + d[2] * (r2 + T(2) * y * y) + 2 * d[3] * x * y) + camera.cy;
    field->Evaluate(v, u, residual);
    residual[0] /= settings->image_sigma;
    return true;
  }
};

void Reference(benchmark::State& state) {
  const std::deque<WindowNode> nodes = Nodes(6, 1000);
  const AlignmentSettings settings = Alignment();
  for (auto _ : state) {
    std::vector<StateBlocks> blocks;
    blocks.reserve(nodes.size());
    std::deque<PointResidual::Grid> grids;
    std::deque<ceres::BiCubicInterpolator<PointResidual::Grid>> fields;
    for (const WindowNode& node : nodes) blocks.push_back(ToBlocks(node.state));
    ceres::Problem problem;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      problem.AddParameterBlock(blocks[k].pose.data(), 7, new PoseManifold);
      problem.AddParameterBlock(blocks[k].motion.data(), 9);
      const cv::Mat& image = nodes[k].field->image(0);
      grids.emplace_back(image.data, 0, image.rows, 0, image.cols);
      fields.emplace_back(grids.back());
      for (std::size_t i = 0; i < nodes[k].points.size(); ++i) {
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointResidual, 1, 7>(
                                     new PointResidual{&settings, &fields.back(), nodes[k].points.At(i)}),
                                 new ceres::CauchyLoss(settings.kernel.scale), blocks[k].pose.data());
      }
      if (k == 0) continue;
      problem.AddResidualBlock(new ImuFactor(ImuTerm(nodes[k].imu.get(), kGravity, 2)), nullptr,
                               blocks[k - 1].pose.data(), blocks[k - 1].motion.data(), blocks[k].pose.data(),
                               blocks[k].motion.data());
    }
    problem.AddResidualBlock(new PriorFactor(Prior(nodes.front().state)), nullptr, blocks[0].pose.data(),
                             blocks[0].motion.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.function_tolerance = 1e-5;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    state.counters["iterations"] = static_cast<double>(summary.iterations.size());
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3d>(blocks.back().pose.data());
    state.counters["error_mm"] = 1e3 * (p - synthetic::Motion().Position(ToSeconds(nodes.back().t))).norm();
  }
}
BENCHMARK(Reference)->Name("Window solve/reference")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evit::bench
