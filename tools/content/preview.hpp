#pragma once

// A plain CPU picture of textured meshes, to judge content without a GPU.

#include "tools/content/model.hpp"

namespace espalier::content {

struct PreviewItem {
    const Mesh* mesh = nullptr;
    const Picture* color = nullptr;   // alpha below a half is cut out
    const Picture* normal = nullptr;  // or null
    bool repeat = false;
    glm::mat4 place{1};
};

struct PreviewView {
    glm::vec3 eye{4, 3, 6}, target{0, 1.5f, 0};
    float fovDegrees = 40;  // vertical
    int width = 1280, height = 720;
    glm::vec3 toSun{0.5f, 0.7f, 0.6f};
    bool shadows = true;
};

Picture preview(const std::vector<PreviewItem>& items, const PreviewView& view);

}  // namespace espalier::content
