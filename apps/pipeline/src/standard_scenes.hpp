// Scenes in which every part of an exposure is timed.
#pragma once

#include <string>
#include <vector>

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/sim/simulator.hpp"

namespace astroid {

struct StandardScene {
  std::string name;
  Mission mission;
  StarCatalogue catalogue;
};

/// Together they have every effect and every way to make the noiseless image.
std::vector<StandardScene> standard_scenes();

}  // namespace astroid
