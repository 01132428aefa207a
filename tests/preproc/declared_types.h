// A data type that is made of another that is made of heights.
#pragma once

namespace belvedere::testing_types {

// 1 where a slope is 20 degrees or more. Of a layer of type "slope angle".
inline constexpr const char* kSteepType = R"([[type]]
name = "steep"
parent = "slope angle"
meta = "surface property"
read = "property pages"
process = [{ module = "classes", limits = 20 }]
write = "property pages"
classes = [{ name = "no", colour = "#00000000" }, { name = "yes", colour = "#ff0000" }]
)";

}  // namespace belvedere::testing_types
