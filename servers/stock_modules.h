// Stock modules: the layers that every run has.
//
//   (dataset's own)  each elevation and imagery layer of the dataset, by its name; imagery gets its mip levels here.
//                    Of a layer that changes with the time, each step: the first by the layer's name
//                    A surface property is shown in the colours of its classes (property_tint.h)
//   terrain          what is drawn of heights: of the first elevation layer, wherever any elevation or imagery exists,
//                    so that imagery finer than the heights has a surface to lie on. All 32 roots always exist
//   grid             lines of latitude and longitude, where terrain exists
//   quadcodes        borders and names of quadnodes, where terrain exists
//   relief           shaded relief, where heights exist; so too
//   slope            colours by steepness,
//   contours         lines of equal height above the sea,
//   water            and where the sea is
//   model            the models of the catalogue
//
// A damaged elevation page is marked failed, with its reason; the terrain there is made of its ancestor's heights, in
// the end of none, so that there is never a hole.
//
// Threads: RegisterStockModules at start, by one thread.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"
#include "runtime/paging/model_catalogue.h"
#include "servers/read_module.h"

namespace belvedere {

inline constexpr const char* kTerrainLayer = "terrain";
inline constexpr const char* kGridLayer = "grid";
inline constexpr const char* kQuadcodeLayer = "quadcodes";
inline constexpr const char* kReliefLayer = "relief";
inline constexpr const char* kSlopeLayer = "slope";
inline constexpr const char* kContourLayer = "contours";
inline constexpr const char* kWaterLayer = "water";
inline constexpr const char* kModelLayer = "model";

inline constexpr int kMostTerrainThreads = 4;

struct StockOptions {
  double exaggeration = 1;  // of heights, station-wide; > 0
  int terrain_threads = 0;  // 0: one a core, kMostTerrainThreads at most
};

// Fails when a layer of the dataset has the name of another. The dataset and the catalogue outlive the registry.
Status RegisterStockModules(ModuleRegistry& registry, const Dataset& dataset, const ModelCatalogue& models,
                            const StockOptions& options);

}  // namespace belvedere
