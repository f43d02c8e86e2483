#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"

#include "lidar_panoptic_clustering/core/one_sweep.h"

#include <cxxabi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
class Stopwatch
{
public:
  /// Milliseconds since the last call or the construction.
  double lap()
  {
    const auto now = Clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(start_, now)).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

[[noreturn]] void throwNoScanLines(std::size_t points)
{
  throw std::invalid_argument(
      "expected scan lines (rows of an organised cloud), found one row of " + std::to_string(points) +
      " points that do not come in one sweep, as of a lidar without scan lines or of several "
      "lidars merged: use an algorithm that works on points alone (birds_eye, euclidean, supervoxel)");
}
/// The name of its class, "my_package::MyClusterer".
std::string nameOf(const Clusterer& clusterer)
{
  const char* mangled = typeid(clusterer).name();
  int failed = 0;
  const std::unique_ptr<char, void (*)(void*)> name(abi::__cxa_demangle(mangled, nullptr, nullptr, &failed), std::free);
  return name ? name.get() : mangled;
}

/// Holds a clusterer, which may be a user's own, to its contract: all that follows indexes with what it wrote.
void requireComponents(const std::vector<std::uint32_t>& component, std::size_t points, const Clusterer& clusterer)
{
  std::uint32_t largest = 0;
  for (const std::uint32_t c : component) largest = std::max(largest, c);
  if (component.size() == points && (points == 0 || largest < points)) return;
  const std::string expected = "clusterer " + nameOf(clusterer) + " is broken: expected " + std::to_string(points);
  throw std::logic_error(component.size() != points
                             ? expected + " components, one a thing point, found " + std::to_string(component.size())
                             : expected + " thing points' components below that, found " + std::to_string(largest));
}

std::unique_ptr<Clusterer> requireClusterer(std::unique_ptr<Clusterer> clusterer)
{
  if (!clusterer) throw std::invalid_argument("a pipeline needs a clusterer, found none");
  return clusterer;
}
}  // namespace

FramePipeline::FramePipeline(std::shared_ptr<const ClassTable> table, const PipelineConfig& config,
                             std::unique_ptr<Clusterer> clusterer)
    : table_(std::move(table)),
      selection_(config.selection),
      refinement_(table_, config.refinement),
      vote_(config.refinement.vote),
      clusterer_(requireClusterer(std::move(clusterer)))
{
}

void FramePipeline::reconfigure(const PipelineConfig& config, std::unique_ptr<Clusterer> clusterer)
{
  clusterer = requireClusterer(std::move(clusterer));
  refinement_ = Refinement(table_, config.refinement);
  selection_ = config.selection;
  vote_ = config.refinement.vote;
  clusterer_ = std::move(clusterer);
}

void FramePipeline::segment(const LabelledCloud& in)
{
  segment(in, nullptr);
}

void FramePipeline::process(const LabelledCloud& in, PanopticCloud& out)
{
  segment(in, &out);
  Stopwatch stopwatch;
  paintThings(out);
  times_.paint_ms = stopwatch.lap();
}

void FramePipeline::segment(const LabelledCloud& in, PanopticCloud* out)
try
{
  Stopwatch stopwatch;
  colored_ = false;
  if (in.height == 1 && clusterer_->needsScanLines() && !comesInOneSweep(in)) throwNoScanLines(in.size());
  if (out != nullptr)
    selectThings(in, *table_, selection_, things_, *out);
  else
    selectThings(in, *table_, selection_, things_);
  times_.select_ms = stopwatch.lap();

  clusterer_->cluster(things_, component_);
  requireComponents(component_, things_.size(), *clusterer_);
  times_.cluster_ms = stopwatch.lap();

  refinement_.refine(things_, component_, instances_);
  times_.refine_ms = stopwatch.lap();
  times_.paint_ms = 0.0;
}
catch (...)
{
  things_ = ThingScan();
  instances_ = Instances();  // half a scan's would not fit any cloud
  throw;
}

const std::vector<std::uint32_t>& FramePipeline::colors()
{
  if (!std::exchange(colored_, true)) colors_.follow(instances_);
  return colors_.colors();
}

void FramePipeline::paint(const LabelledCloud& in, PanopticCloud& out)
{
  if (in.width != things_.columns || in.height != things_.rows)
    throw std::invalid_argument("expected the cloud segmented last, " + std::to_string(things_.columns) + " x " +
                                std::to_string(things_.rows) + " (width x height), found one of " +
                                std::to_string(in.width) + " x " + std::to_string(in.height));
  Stopwatch stopwatch;
  copyInClassColors(in, *table_, out);
  paintThings(out);
  times_.paint_ms = stopwatch.lap();
}

/// Ids, colours and votes on a copy in class colours.
void FramePipeline::paintThings(PanopticCloud& out)
{
  const auto& colors = this->colors();
  for (std::uint32_t row = 0; row < things_.rows; ++row)
  {
    PanopticPoint* line = out.points.data() + static_cast<std::size_t>(row) * things_.columns;
    for (std::uint32_t i = things_.line_begin[row]; i < things_.line_begin[row + 1]; ++i)
    {
      const std::uint32_t id = instances_.id[i];
      if (id == 0) continue;
      PanopticPoint& to = line[things_.points[i].column];
      to.instance = id;
      to.rgb = colors[id - 1];
      const ClassIndex voted = votedClass(id, things_.class_index[i]);
      if (voted != things_.class_index[i]) to.label = (*table_)[voted].ids[0];
    }
  }
}
}  // namespace lidar_panoptic_clustering
