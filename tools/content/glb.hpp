#pragma once

// Writing glTF 2.0 binaries and pictures. Every writer replaces its file at the end, or leaves it untouched.

#include <string>

#include "runtime/core/result.hpp"
#include "tools/content/model.hpp"

namespace espalier::content {

struct GlbImage {
    std::string name;
    std::vector<uint8_t> bytes;  // an encoded file
    bool png = false;            // else JPEG
};

struct GlbMaterial {
    std::string name;
    int colorImage = -1, normalImage = -1;  // indices of images
    float roughness = 0.9f;
    float alphaCutoff = 0;  // 0: opaque
    bool doubleSided = false;
    bool repeat = false;  // textures tile
};

struct GlbMesh {
    std::string name;
    const Mesh* mesh = nullptr;
    int material = 0;
    float pixels = 0;  // as TerminalLod::pixels, in its extras; 0: isn't said
};

struct Glb {
    std::vector<GlbImage> images;
    std::vector<GlbMaterial> materials;
    std::vector<GlbMesh> meshes;  // a node each, named as the mesh
};

std::vector<uint8_t> encodePng(const Picture& picture, int channels);  // 1, 3 or 4 channels kept
std::vector<uint8_t> encodeJpeg(const Picture& picture, int quality);

Status writeBytes(const std::string& path, const std::vector<uint8_t>& bytes);
Status writeGlb(const std::string& path, const Glb& glb);

}  // namespace espalier::content
