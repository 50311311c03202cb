#pragma once

// Names and numbers of the file format that its writer and reader share; see docs/surface_format.md.

#include <cstddef>
#include <cstdint>

namespace espalier::surface_file {

inline constexpr const char* kExtension = "ESPALIER_surface";
inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr uint32_t kVersion = 3;
inline constexpr uint32_t kMaxCoarser = 32;  // coarser meshes in a file
inline constexpr size_t kMaxImages = 4096, kMaxMaterials = 1 << 16, kMaxViews = 1 << 20;

}  // namespace espalier::surface_file
