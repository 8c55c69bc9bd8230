#include "common/tracking/sliding_window.h"

namespace evit {

SlidingWindow::SlidingWindow(AlignmentSettings alignment, double gravity, const WindowOptions& options)
    : alignment_(std::move(alignment)), gravity_(gravity), options_(options) {}

void SlidingWindow::Start(std::deque<WindowNode> nodes, const StatePrior& prior) {
  nodes_ = std::move(nodes);
  prior_ = prior;
}

KeyframeLink SlidingWindow::Link(const WindowNode& node) const {
  const ImuTerm imu(node.imu.get(), gravity_, options_.imu_noise_factor);
  if (!node.stood_still) return KeyframeLink(imu);
  return KeyframeLink(imu, StandstillTerm(node.imu->dt()));
}

StatePrior SlidingWindow::Eliminate(const StatePrior& prior, const AlignmentTerm& alignment,
                                    std::size_t n) const {
  return Marginalize(prior, alignment, Link(nodes_[n + 1]), nodes_[n].state, nodes_[n + 1].state);
}

void SlidingWindow::Push(WindowNode node) {
  if (nodes_.size() >= static_cast<std::size_t>(options_.size)) {
    if (options_.first_node == WindowOptions::FirstNode::kPrior)
      prior_ = Eliminate(prior_, AlignNear(nodes_.front().state.T_map_body, &nodes_.front()), 0);
    nodes_.pop_front();
  }
  nodes_.push_back(std::move(node));
}

// Most nodes hardly move from one solve to the next, and hardly any does in the last iterations. While a pose
// changes the residuals by less than kSame, the quadratic function around its last evaluation is used.
AlignmentTerm SlidingWindow::AlignNear(const SE3& T_map_body, WindowNode* node) const {
  // Of a residual's standard deviation, root mean square over the points: two grey levels, on an edge
  // less than a tenth of a pixel, far inside the valley that the quadratic function describes.
  constexpr double kSame = 2e-2;
  LocalAlignment& local = node->local;
  if (local.known) {
    Vector6d d;
    d << T_map_body.p - local.T_map_body.p, LogSO3(local.T_map_body.q.conjugate() * T_map_body.q);
    // By its bend: along a ridge the Hessian is zero, and the quadratic function would hold at any distance.
    if (d.dot(local.bend * d) <= kSame * kSame * static_cast<double>(node->points.size())) {
      const Vector6d bent = local.term.hessian * d;
      AlignmentTerm term = local.term;
      term.cost += d.dot(term.gradient + 0.5 * bent);
      term.gradient += bent;
      return term;
    }
  }
  local.known = true;
  local.T_map_body = T_map_body;
  local.term = EvaluateAlignmentExactly(alignment_, *node->field, node->points, T_map_body, &local.bend);
  return local.term;
}

ChainModel SlidingWindow::ModelAt(const std::vector<BodyState>& states,
                                  const std::vector<KeyframeLink>& links) {
  ChainModel model(states.size());
  for (std::size_t n = 0; n < states.size(); ++n) {
    const AlignmentTerm term = AlignNear(states[n].T_map_body, &nodes_[n]);
    model.cost += term.cost;
    model.gradient[n].head<6>() += term.gradient;
    model.diagonal[n].topLeftCorner<6, 6>() += term.hessian;
    if (n == 0) continue;
    const KeyframeLink::Term joined = links[n - 1].Evaluate(states[n - 1], states[n]);
    model.cost += joined.cost;
    model.gradient[n - 1] += joined.gradient_i;
    model.gradient[n] += joined.gradient_j;
    model.diagonal[n - 1] += joined.hessian_ii;
    model.diagonal[n] += joined.hessian_jj;
    model.upper[n - 1] = joined.hessian_ij;
  }
  if (options_.first_node == WindowOptions::FirstNode::kPrior) {
    const PriorTerm prior = EvaluatePrior(prior_, states[0]);
    model.cost += prior.cost;
    model.gradient[0] += prior.gradient;
    model.diagonal[0] += prior.hessian;
  } else if (states.size() > 1) {  // it stays where it is
    model.gradient[0].setZero();
    model.diagonal[0].setIdentity();
    model.upper[0].setZero();
  }
  return model;
}

SlidingWindow::Summary SlidingWindow::Solve() {
  std::vector<BodyState> states;
  std::vector<KeyframeLink> links;
  for (WindowNode& node : nodes_) {
    states.push_back(node.state);
    if (node.imu && node.imu->NeedsRepropagation(node.state.bias)) node.imu->Repropagate(node.state.bias);
    if (states.size() > 1) links.push_back(Link(node));
  }
  ChainOptions options;
  options.max_iterations = options_.max_iterations;
  options.time_budget = time_budget_;
  const ChainSummary summary = MinimizeChain(
      options, [&](const std::vector<BodyState>& at) { return ModelAt(at, links); }, &states);
  const Summary result{summary.iterations, summary.usable};
  if (!result.usable) return result;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].state = states[n];
    nodes_[n].state.T_map_body.q.normalize();
  }
  // Once per keyframe is enough: later moves of a node are far smaller than what would change its curvature.
  for (WindowNode& node : nodes_) {
    if (node.alignment.cost == 0) node.alignment = AlignNear(node.state.T_map_body, &node);
  }
  return result;
}

void SlidingWindow::DropNewestAlignment(const std::vector<BodyState>& states) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n].state = states[n];
  nodes_.back().points = {};
  nodes_.back().alignment = {};
  nodes_.back().local = {};
}

SlidingWindow::Summary SlidingWindow::HoldNewest() {
  nodes_.back().stood_still = true;
  return Solve();
}

Matrix15d SlidingWindow::NewestInformation() const {
  StatePrior prior = prior_;
  if (options_.first_node == WindowOptions::FirstNode::kFixed)
    prior.information = 1e12 * Matrix15d::Identity();
  prior.mean = nodes_.front().state;  // only the information matters here
  for (std::size_t n = 0; n + 1 < nodes_.size(); ++n) prior = Eliminate(prior, nodes_[n].alignment, n);
  Matrix15d information = prior.information;
  information.topLeftCorner<6, 6>() += nodes_.back().alignment.hessian;
  return 0.5 * (information + information.transpose());
}

}  // namespace evit
