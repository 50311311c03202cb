#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "plugin_api/espalier.h"
#include "plugin_api/espalier.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {

// A game as the plugin meets one: its own device, its own picture and depth buffer, boxes that it draws itself.
class DrawingHost {
  public:
    static constexpr uint32_t kWidth = 320, kHeight = 240;
    struct Depth {
        VkFormat format = VK_FORMAT_D32_SFLOAT;
        bool reversed = true;  // 1 at the near plane, 0 infinitely far; else 0 at the near plane, 1 at kFar
    };
    static constexpr float kNear = .05f, kFar = 20;
    struct Box {
        glm::vec3 low, high, tint;
    };
    struct Picture {
        std::vector<uint8_t> rgba;
        std::vector<float> depth;  // of D32 and D16 only

        bool sameColour(const Picture& other, size_t pixel) const;
    };

    DrawingHost();
    ~DrawingHost();  // after espDestroy; checks that the validation layer was silent

    EspHostDevice device() const;
    // Whether the GPU has such a depth buffer that can be sampled.
    bool has(VkFormat format) const;
    // Pictures are of these formats from now on, kWidth × kHeight, so many times as large.
    void use(VkFormat colour, const Depth& depth, uint32_t times = 1);

    // A picture of the boxes; with a context growth is drawn into it, with `surfaces` its surfaces too.
    Picture draw(const EspCamera& camera, const std::vector<Box>& boxes, EspContext* context, bool surfaces = false);
    // Has such a frame recorded, and neither submits it nor says so.
    void recordInVain(const EspCamera& camera, EspContext* context);
    // Frames of the plugin's own pictures for each camera, all recorded before the first is submitted; waits for none.
    std::vector<Image> submit(const std::vector<EspCamera>& cameras, EspContext* context);
    // The same as pictures.
    std::vector<Picture> drawAtOnce(const std::vector<EspCamera>& cameras, EspContext* context);

    EspHostScene scene() const;  // as draw() hands it in
    esp::DrawDef def(const EspCamera& camera, const Commands& commands) const;
    // Metres along the view, of a depth that the buffer holds.
    double distance(float depth) const;

  private:
    void makeImages();
    Picture read();

    std::unique_ptr<Device> device_;
    VkFormat colour_ = VK_FORMAT_R8G8B8A8_UNORM;
    Depth depth_;
    uint32_t width_ = kWidth, height_ = kHeight;
    Image picture_, nearest_;
    Program box_;
    uint64_t frame_ = 0;
};

}  // namespace espalier
