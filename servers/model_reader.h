// Model reader: from a model file (glTF or OBJ) of the catalogue's folder to a model page.
//
// The file's nodes are joined into one mesh (those that move by themselves, and those where something is attached, 256
// at most, are known by their names: ModelJoint and ModelStation in page.h), turned from glTF's axes (y up, z forward)
// to the body frame, and scaled so that the model is as long as the catalogue says; its origin stays where the file has
// it. Vertices get one colour each: the material's, times the mean of its texture, times the vertex's own.
//
// Levels of detail have about 1, 1/4 and 1/16 of the triangles; each knows how far its surface may be from the first. A
// level that would save little is left out.
//
// Threads: any; keeps nothing between calls.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/model_catalogue.h"
#include "runtime/paging/page.h"

#include <memory>

namespace belvedere {

// Reads FOLDER/NAME.gltf, .glb or .obj, whichever is there first.
Result<std::unique_ptr<ModelPage>> ReadModel(const ModelCatalogue& models, int number);

// The same from one file. length_m: from nose to tail.
Result<std::unique_ptr<ModelPage>> ReadModelFile(const std::string& path, float length_m);

}  // namespace belvedere
