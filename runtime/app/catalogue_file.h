// The catalogue of models: a folder of model files with a catalogue.toml that says how long each is, which symbol
// stands for it and which entity types look like it.
//
// Threads: pure function.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/model_catalogue.h"
#include "runtime/scene/entity_looks.h"

#include <string>

namespace belvedere {

struct Catalogue {
  ModelCatalogue models;
  EntityLooks looks;  // whose model numbers are those of `models`
};

Result<Catalogue> LoadCatalogue(const std::string& folder);

}  // namespace belvedere
