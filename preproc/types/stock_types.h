// Stock types: the data types that every spec has, in the language of those that it adds (data_type.h).
#pragma once

namespace belvedere {

inline constexpr const char* kStockTypes = R"(
# Made of sources: the builder composes them quadnode by quadnode, the finest first (layer_builder.h).
[[type]]
name = "elevation"
meta = "height field"
read = "raster sources"
write = "height pages"

[[type]]
name = "imagery"
meta = "image"
read = "raster sources"
write = "image pages"

# Made of sources, and cut into quadnodes (vectors/feature_cutter.h).
[[type]]
name = "vector"
meta = "vector"
read = "vector sources"
write = "vector pages"

# Made of the pages of another layer.
[[type]]
name = "slope angle"
parent = "elevation"
meta = "surface property"
read = "height pages"
process = ["slope"]
write = "property pages"
unit = "deg"
gain = 0.5

[[type]]
name = "normal map"
parent = "elevation"
meta = "surface property"
read = "height pages"
process = ["normals"]
write = "property pages"
channels = 3
offset = -1
gain = 0.00784313725490196

[[type]]
name = "roughness"
parent = "elevation"
meta = "surface property"
read = "height pages"
process = ["roughness"]
write = "property pages"
unit = "m"
gain = 0.25

[[type]]
name = "water mask"
parent = "elevation"
meta = "surface property"
read = "height pages"
process = ["water"]
write = "property pages"
classes = [{ name = "land", colour = "#00000000" }, { name = "water", colour = "#2060a0a0" }]

[[type]]
name = "buildings"
parent = "vector"
meta = "model"
read = "vector pages"
process = ["raise"]
write = "model pages"
)";

}  // namespace belvedere
