// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/base/options.hpp"

namespace colonnade {

struct AssociationOptions {
  static constexpr const char* kSection = "Association";
  std::string method = "jcbb";
  double pillar_probability = 0.99;
  double floor_edge_probability = 0.99;
  double depth_slope_probability = 0.99;
  double joint_probability = 0.99;
  double clutter = 0.5;
  int joint_nodes = 2000;
  int consensus_matches = 0;
  double near_factor = 2.0;
  double floor_edge_gap_m = 1.5;
  double looks_probability = 0.999;
  double colour_sigma = 20.0;
  double width_sigma = 0.2;

  void visit(OptionVisitor& v) {
    v.choice("method", method, {"nearest", "jcbb"},
             "nearest pairs first, or the largest set that passes the joint chi-square test");
    v.number(
        "pillar_probability", pillar_probability, {0.5, 0.999999},
        "share of right pillar edges the gate lets through; Filter.gate_probability bounds it");
    v.number("floor_edge_probability", floor_edge_probability, {0.5, 0.999999},
             "the same of floor edges");
    v.number("depth_slope_probability", depth_slope_probability, {0.5, 0.999999},
             "the same of depth corners");
    v.number("joint_probability", joint_probability, {0.5, 0.999999},
             "share of right joint hypotheses the joint chi-square test lets through");
    v.number("clutter", clutter, {0, 10},
             "share of the detections that no pair explains, and of its own, that may be of "
             "something else: a pair must be likelier than that; 0: it need not");
    v.integer("joint_nodes", joint_nodes, {1, 1000000},
              "of its tree jcbb visits at most in one frame; then the best set so far counts");
    v.integer("consensus_matches", consensus_matches, {0, 1000},
              "so many matches or more pass one-point RANSAC first; 0: never");
    v.number("near_factor", near_factor, {1, 100},
             "a detection within this many times the gate of a landmark founds no new one");
    v.number("floor_edge_gap_m", floor_edge_gap_m, {0, 20},
             "between the seen parts of one floor edge");
    v.number("looks_probability", looks_probability, {0.5, 1},
             "share of right pairs whose looks are alike enough; 1: looks refuse nothing");
    v.number("colour_sigma", colour_sigma, {1, 255},
             "gray levels by which one side of one edge differs from picture to picture");
    v.number("width_sigma", width_sigma, {0.01, 10}, "of a pillar's width, as a share of it");
  }
};

}  // namespace colonnade
