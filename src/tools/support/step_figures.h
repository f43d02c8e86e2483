#pragma once

#include "lidar_panoptic_clustering/drawing/scan_figure.h"
#include "tools/support/figure_scan.h"
#include "tools/support/step_scene.h"

#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace detail
{
inline ParameterMap refinementSteps(bool bridge, bool split, bool merge, bool vote)
{
  return {{"bridge_distance_m", bridge ? 0.3 : 0.0}, {"split", split}, {"merge", merge}, {"vote", vote}};
}

inline ScanFigureOptions sceneOptions(int panel_width_px, int columns)
{
  ScanFigureOptions options;
  options.panel_width_px = panel_width_px;
  options.columns = columns;
  options.window = ViewWindow{-0.8, 21.6, -6.6, 8.6};
  options.range_images = false;
  options.counts = false;
  return options;
}

/// The scene of the steps, clustered; single echoes through window panes have no box.
inline FigureScan clusterScene(const LabelledCloud& cloud, const std::string& algorithm, const ParameterMap& parameters)
{
  constexpr std::uint32_t kFewest = 5;
  return clusterForFigure(cloud, algorithm, parameters, kFewest);
}

/// Each object in its own colour.
inline ScanPanel panelOf(const std::string& title, const FigureScan& scan)
{
  const std::size_t count = scan.boxes.size();
  return {title, &scan.cloud, {}, std::to_string(count) + (count == 1 ? " object" : " objects"), scan.boxes};
}

/// What the class colours mean.
inline std::vector<MarkMeaning> classLegend(const std::vector<std::string>& names)
{
  const ClassTable table = ClassTable::load("semantic_kitti");
  std::vector<MarkMeaning> legend;
  for (const std::string& name : names) legend.push_back({table[table.findByName(name)].rgb, name});
  return legend;
}
}  // namespace detail

/// One picture a step of the refinement, before and after it, as `folder`/step_bridge.png and so on; and
/// `folder`/step_cluster.png, from labels to clusters. Throws as makeAlgorithm and drawScanFigure do.
inline void drawStepFigures(const std::string& folder, const std::string& algorithm)
{
  const LabelledCloud cloud = withoutInstances(stepScene());
  const auto run = [&](bool bridge, bool split, bool merge, bool vote)
  { return detail::clusterScene(cloud, algorithm, detail::refinementSteps(bridge, split, merge, vote)); };
  const FigureScan clustered = run(false, false, false, false), bridged = run(true, false, false, false),
                   parted = run(true, true, false, false), merged = run(true, true, true, false);
  ScanFigureOptions options = detail::sceneOptions(720, 2);
  const auto draw = [&](const std::string& step, const ScanPanel& before, const ScanPanel& after) {
    drawScanFigure({before, after}, folder + "/step_" + step + ".png", options);
  };
  draw("bridge", detail::panelOf("cluster", clustered), detail::panelOf("bridge", bridged));
  draw("split", detail::panelOf("bridge", bridged), detail::panelOf("split", parted));
  draw("merge", detail::panelOf("split", parted), detail::panelOf("merge", merged));

  options.mark_legend = detail::classLegend({"car", "truck", "person", "bicyclist"});
  options.title = "Left: one colour a class";
  FigureScan labels = clustered;
  colorByClass(labels.cloud);
  draw("cluster", {"labels", &labels.cloud, {}, "", {}}, detail::panelOf("cluster", clustered));

  options.title = "One colour a class";
  FigureScan unvoted = merged, voted = run(true, true, true, true);
  colorByClass(unvoted.cloud), colorByClass(voted.cloud);
  draw("vote", {"merge", &unvoted.cloud, {}, "", unvoted.boxes}, {"vote", &voted.cloud, {}, "", voted.boxes});
}

/// All algorithms on the same scene, each by its rule and the class table's link distances alone, as
/// `folder`/algorithms.png. Throws as drawScanFigure does.
inline void drawAlgorithmFigure(const std::string& folder)
{
  const LabelledCloud cloud = withoutInstances(stepScene());
  std::vector<FigureScan> scans;
  for (const std::string& algorithm : algorithmNames())
    scans.push_back(detail::clusterScene(cloud, algorithm, detail::refinementSteps(false, false, false, false)));
  std::vector<ScanPanel> panels;
  for (std::size_t i = 0; i < scans.size(); ++i)
  {
    panels.push_back(detail::panelOf(algorithmNames()[i], scans[i]));
    for (NamedBox& box : panels.back().boxes) box.text.clear();
  }
  drawScanFigure(panels, folder + "/algorithms.png", detail::sceneOptions(720, 2));
}
}  // namespace lidar_panoptic_clustering
