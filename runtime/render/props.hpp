#pragma once

// Props: trees, walls, grass and whatever else a scene is furnished with. They are only looked at: nothing grows on
// them.

#include <optional>

#include "runtime/emit/terminals.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/render/shading.hpp"
#include "shaders/render/prop_records.h"

namespace espalier {

struct PropPlace {
    uint32_t variant = 0;  // in TerminalData::variants
    glm::vec3 position{0};
    float turn = 0;  // radians about the vertical, counterclockwise from above
    float scale = 1;
};

// Picks a level of detail for each prop in view on the CPU (there are thousands, not millions) and draws each level's
// instances at once. Cut-out materials are foliage, lit at vertices; one called "grass" takes the meadow's colour and
// is drawn near by only, one called "meadow" has the meadow's hue where it stands.
class Props {
  public:
    // Formats and samples of the picture that it draws into.
    static Result<Props> create(Device& device, TerminalData models, VkFormat color, VkFormat depth, uint32_t samples);

    const std::vector<TerminalVariant>& variants() const { return terminals_.data().variants; }
    // In place of all that stood. Variants must be there.
    Status place(Device& device, std::vector<PropPlace> places);
    bool empty() const { return places_.empty(); }
    void bounds(glm::vec3& low, glm::vec3& high) const;  // of what stands; leaves them alone if nothing does

    // What draw (drawDepth) draws: before its pass, whenever the view changed. sunClip: world -> the sun's clip space.
    Status choose(Commands& commands, const FrameRecord& frame);
    Status chooseCasters(Commands& commands, const glm::mat4& sunClip);
    void draw(DrawPass& pass, const Buffer& frame, const Binding& shadow, Shading shading) const;
    void drawDepth(DrawPass& pass, const Buffer& frame) const;
    void forget() { chosenFor_ = {}; }  // the last recording won't be submitted

  private:
    // What a variant takes up however it is turned: a cylinder about its origin's vertical.
    struct Room {
        float around = 0, foot = 0, top = 0;
    };
    struct Box {
        glm::vec3 low, high;
    };
    // Instances of one level of detail, one after another.
    struct Run {
        uint32_t bucket = 0, first = 0, count = 0;
    };
    struct Chosen {
        std::vector<Run> runs;
        Buffer instances;
        TexelView texels;
    };
    struct Level {
        std::vector<std::pair<float, PropInstance>> seen;  // by distance
    };
    // What a choice depends on: pictures of two sizes may have one matrix.
    struct View {
        glm::mat4 viewProjection{0};
        float pixelScale = 0, unit = 0;
        bool operator==(const View&) const = default;
    };
    void measure();
    Box boxOf(const PropPlace& place) const;
    const TerminalMaterial& materialOf(const PropPlace& place) const;  // of its finest level
    Status makePrograms(Device& device, VkFormat color, VkFormat depth, uint32_t samples);
    Status upload(Commands& commands, std::vector<Level>& levels, Chosen& out) const;
    void drawRuns(DrawPass& pass, const Chosen& chosen, const Buffer& frame, const Binding* shadow,
                  Shading shading) const;
    PropPush pushOf(uint32_t bucket, uint32_t first) const;

    Terminals terminals_;
    Sampler sampler_, quickSampler_;
    std::vector<Room> rooms_;  // [variant]
    std::vector<float> tops_;  // [bucket]: Room::top
    std::vector<PropPlace> places_;
    std::vector<PropInstance> instances_;  // [place], whole
    Program built_[kShadings], foliage_[kShadings];
    Program depth_;
    Chosen inView_, casters_;
    View chosenFor_;
};

}  // namespace espalier
