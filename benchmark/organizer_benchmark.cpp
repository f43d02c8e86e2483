// Time of the organizer on each layout, one thread, in copies of the labelled 64 x 2048 cloud; vlp16 makes clouds of 16
// x 1800, os1_128 of 128 x 1024.
#include "measure.h"

#include "lidar_panoptic_clustering/projection/original_cloud.h"

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::size_t kFrames = 10;  // together too large for the cache, as frames from a driver are

/// A sensor's frames in one layout, and the same as labelled clouds.
struct Frames
{
  std::vector<RawMessage> messages;
  Scans images;
};

RawMessage messageOf(const std::string& layout, const LabelledCloud& image)
{
  if (layout == "rows_are_rings") return organisedMessage(image);
  if (layout == "rows_are_firings") return transposed(organisedMessage(image));
  const Order returns = returnsOf(image);
  if (layout == "ring") return oneRow(image, byFiring(returns, image.width), Rings::kFromTheBottom);
  if (layout == "ring_shuffled") return oneRow(image, shuffled(returns), Rings::kFromTheBottom);
  if (layout == "beams") return oneRow(image, byFiring(returns, image.width), Rings::kNone);
  if (layout == "unfold") return oneRow(image, asKittiHasIt(returns, image), Rings::kNone);
  return oneRow(image, returns, Rings::kNone);
}

Frames framesOf(const std::string& sensor, const std::string& layout)
{
  Frames frames;
  for (std::size_t i = 0; i < kFrames; ++i)
  {
    frames.images.push_back(simulatedScan(sensor, 10 * i));
    frames.messages.push_back(messageOf(layout, frames.images.back()));
  }
  return frames;
}

void organize(benchmark::State& state, const std::string& sensor, const std::string& layout)
{
  const Frames frames = framesOf(sensor, layout);
  OrganizerConfig config;
  if (layout == "beams") config.sensor = sensor;
  if (layout == "merged") config.layout = layout;
  Organizer organizer(config);
  OrganizedScan out;
  measure(state, [&](std::size_t i) { organizer.organize(frames.messages[i % kFrames].view(), out); });
  state.counters["points"] = static_cast<double>(out.points.size());
}

void addLabelsToOriginal(benchmark::State& state, const std::string& sensor)
{
  const Frames frames = framesOf(sensor, "rows_are_rings");
  const std::vector<std::uint32_t> ids(frames.images[0].size(), 1);
  OriginalCloud out;
  measure(state, [&](std::size_t i) { addLabels(frames.messages[i % kFrames].view(), ids, ids, out); });
}

void addAll()
{
  for (const std::string sensor : {"vlp16", "hdl64e", "os1_128"})
  {
    for (const std::string layout :
         {"rows_are_rings", "rows_are_firings", "merged", "ring", "ring_shuffled", "beams", "unfold"})
      add(sensor + "/" + layout, [sensor, layout](benchmark::State& state) { organize(state, sensor, layout); });
    add(sensor + "/add_labels", [sensor](benchmark::State& state) { addLabelsToOriginal(state, sensor); });
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}
