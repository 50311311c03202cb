#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {

// A game that has the plugin draw within a pass of its own. Its depth buffer is an attachment and nothing else.
class PassHost {
  public:
    static constexpr uint32_t kWidth = 320, kHeight = 240;
    struct Kind {
        VkFormat colour = VK_FORMAT_R8G8B8A8_UNORM, depth = VK_FORMAT_D32_SFLOAT;  // undefined colour: depths only
        uint32_t samples = 1;
        bool reversed = true;
        bool renderPass = false;  // a VkRenderPass, of one sample; else dynamic rendering
        EspOutput output = ESP_OUTPUT_ENCODED;
        float exposure = 0;  // stops
    };
    struct View {
        glm::mat4 view, projection;
        bool upwards = false;  // y goes up in clip space; the viewport turns it over
    };
    struct Box {
        glm::vec3 low, high, tint;
    };
    struct Picture {
        std::vector<glm::vec4> colour;  // as the format holds it
        std::vector<float> depth;
    };

    PassHost();
    ~PassHost();  // after espDestroy; checks that the validation layer was silent
    EspHostDevice device() const;
    uint32_t sampleCounts() const;  // VkSampleCountFlags of pictures and depth buffers

    Picture draw(const Kind& kind, const View& view, const std::vector<Box>& boxes, EspContext* context,
                 bool surfaces = false);

  private:
    struct Pass;

    std::unique_ptr<Device> device_;
    uint64_t frame_ = 0;
};

}  // namespace espalier
