# One precompiled header for the libraries of the bench: the headers that most of their files include.
file(WRITE ${PROJECT_BINARY_DIR}/precompiled.cpp "")
add_library(lcs_precompiled OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
target_link_libraries(lcs_precompiled PRIVATE Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json
  opencv_core)
target_precompile_headers(lcs_precompiled PRIVATE <Eigen/Core> <Eigen/Geometry> <algorithm> <array>
  <chrono> <cmath> <cstdint> <filesystem> <fmt/format.h> <fmt/ranges.h> <functional> <map> <memory>
  <nlohmann/json.hpp> <numeric> <opencv2/core.hpp> <optional> <set> <span> <stdexcept> <string>
  <string_view> <utility> <variant> <vector>)

# The filter is left out: it must compile without OpenCV and fmt. So are programs and the Python
# module, whose flags differ.
function(lcs_precompile folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
      target_precompile_headers(${target} REUSE_FROM lcs_precompiled)
      foreach(what INCLUDE_DIRECTORIES COMPILE_DEFINITIONS)
        set_property(TARGET ${target} APPEND PROPERTY ${what} $<TARGET_PROPERTY:lcs_precompiled,${what}>)
      endforeach()
    endif()
  endforeach()
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(folder IN LISTS folders)
    lcs_precompile(${folder})
  endforeach()
endfunction()
foreach(folder scenarios sim tools)
  lcs_precompile(${folder})
endforeach()
