// Attachments: where the parts that an entity says are attached to it hang on its model.
//
// Threads: pure.
#pragma once

#include "runtime/paging/page.h"

#include <cstdint>
#include <optional>

namespace belvedere {

// The station's place in the body frame: the model's of that number; else, for the model's own numbers (1 to 511), the
// one that comes at that place in its file. nullopt: it has none, and what hangs there is not shown.
std::optional<glm::vec3> PlaceOfStation(const ModelPage& model, uint16_t station);

}  // namespace belvedere
