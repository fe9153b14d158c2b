// SPDX-License-Identifier: BSD-3-Clause
// Creates the estimator that the configuration names.
#pragma once

#include "slam/slam_config.hpp"

#include <memory>
#include <vector>

namespace waymark {

std::unique_ptr<Estimator> make_estimator(const SlamConfig& config,
                                          std::shared_ptr<const MapSnapshot> loaded_map = nullptr,
                                          std::vector<SurveyedMarker> survey = {});

}  // namespace waymark
