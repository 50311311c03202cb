#pragma once

// Drawing patterns: pieces that stand on surfaces, each a mesh under three axes.

#include <span>

#include "runtime/emit/terminals.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/render/pass_format.hpp"
#include "runtime/render/shading.hpp"
#include "shaders/render/piece_records.h"
#include "shaders/shared/pattern_piece.h"

namespace espalier {

// Picks a level of detail for each piece in view on the CPU, and draws each level's pieces at once.
class PieceDraw {
  public:
    // meshes: by the numbers that pieces carry; kind 0 is none.
    static Result<std::unique_ptr<PieceDraw>> create(Device& device, TerminalData meshes);
    // What pieces are drawn with in one kind of pass.
    static Result<Program> program(Device& device, const PassFormat& pass, Shading shading);

    // In place of all that stood.
    Status place(std::vector<PatternPiece> pieces);
    bool empty() const { return pieces_.empty(); }
    const std::vector<PatternPiece>& pieces() const { return pieces_; }
    const TerminalData& meshes() const { return terminals_.data(); }
    // The variant of those meshes that a piece is drawn as; null: it is missing.
    const TerminalVariant* meshOf(const PatternPiece& piece) const;
    uint64_t revision() const { return revision_; }      // another one whenever something else stands
    void bounds(glm::vec3& low, glm::vec3& high) const;  // of what stands; leaves them alone if nothing does

    // What draw (drawCasters) draws: before its pass, whenever the view changed. lodPixels: error allowed. sunClip:
    // world
    // -> the sun's clip space.
    Status choose(Commands& commands, const FrameRecord& frame, float lodPixels);
    Status chooseCasters(Commands& commands, const glm::mat4& sunClip, float texelsPerMetre);
    // Depth only without a shadow map.
    void draw(DrawPass& pass, const Buffer& frame, const Program& program, const Binding* shadow) const {
        drawRuns(pass, inView_, frame, program, shadow);
    }
    void drawCasters(DrawPass& pass, const Buffer& frame, const Program& program) const {
        drawRuns(pass, casters_, frame, program, nullptr);
    }
    void forget() { chosenFor_ = {}; }  // the last recording won't be submitted

    struct Stats {
        uint32_t pieces = 0;
        uint64_t triangles = 0;
    };
    Stats stats() const;  // of what was chosen last

  private:
    explicit PieceDraw(Device& device) : device_(device) {}
    // Pieces of one level of detail, one after another.
    struct Run {
        uint32_t bucket = 0, first = 0, count = 0;
    };
    struct Chosen {
        std::vector<Run> runs;
        Buffer instances;
        TexelView texels;
    };
    struct View {
        glm::mat4 viewProjection{0};
        float pixelScale = 0, lodPixels = 0;
        bool operator==(const View&) const = default;
    };
    struct Sphere {
        glm::vec3 centre;
        float radius, scale;  // scale: the longest axis
    };
    Status upload(Commands& commands, std::span<const std::vector<PatternPiece>> levels, Chosen& out) const;
    void drawRuns(DrawPass& pass, const Chosen& chosen, const Buffer& frame, const Program& program,
                  const Binding* shadow) const;
    const VariantRecord* variantOf(const PatternPiece& piece) const;  // null: its mesh is missing

    Device& device_;
    Terminals terminals_;
    std::vector<PatternPiece> pieces_;
    std::vector<Sphere> spheres_;
    Sampler sampler_;
    Chosen inView_, casters_;
    View chosenFor_;
    uint64_t revision_ = 0;
};

}  // namespace espalier
