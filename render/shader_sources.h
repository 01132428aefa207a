// The shaders of shaders/, put into the program when it is built: nothing is looked up when it runs.
#pragma once

#include <string_view>

namespace belvedere::shaders {

extern const std::string_view kView;        // blocks that every shader of a view reads
extern const std::string_view kAtmosphere;  // functions of light and air
extern const std::string_view kTerrainVert, kTerrainFrag;
extern const std::string_view kSkyVert, kSkyFrag;
extern const std::string_view kModelVert, kModelFrag;
extern const std::string_view kOverlayVert, kOverlayFrag;
extern const std::string_view kEffectVert, kEffectFrag;
extern const std::string_view kVolumeVert, kVolumeFrag;

}  // namespace belvedere::shaders
