#pragma once

// A context's streamed surfaces: which of them stand, by need and within a budget.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "runtime/plugin/surface_read.hpp"

namespace espalier {

class Streaming {
  public:
    explicit Streaming(EspContext& context) : context_(context) {}
    Streaming(const Streaming&) = delete;

    // low, high: of the file, before its place. Away at first.
    EspResult add(SurfaceRequest request, glm::vec3 low, glm::vec3 high, EspSurface* out);
    void set(const EspStreamingDef& def) { def_ = def; }
    bool knows(uint32_t id) const { return surfaces_.contains(id); }
    // The host has destroyed it, standing or away.
    void forget(uint32_t id);

    // Begins and ends loads. In each update, before these are advanced.
    void advance();
    // What loads ask: whether one whose file has been read may take so many bytes of the device. Sends away what is
    // needed less.
    bool makeRoom(uint32_t load, uint64_t bytes);
    // The load of a surface has come to its end.
    EspResult stand(uint32_t id, SurfaceRead read);
    void failed(uint32_t id, EspResult result, const std::string& message);

    // The world's origin has moved.
    void shift(const glm::dvec3& by);

    // Of surfaces that are away.
    std::vector<PaintedLayer*> layersAway();
    // Ends loads, which hold memory of a device that is about to go. They begin again.
    void endLoads();

    // Of one that stands and is to be read again.
    void loseFile(uint32_t id, EspResult result, const std::string& message);

    EspStreamedInfo infoOf(uint32_t id) const;
    EspStreamingInfo info() const;

  private:
    struct Streamed {
        SurfaceRequest request;
        glm::vec3 middle{0};  // world
        Remainder remainder;  // of it
        float radius = 0;     // world
        uint64_t bytes = 0;   // of the device, which places of one file share; 0: not known yet
        uint64_t hash = 0;    // of the file as it first stood; 0: it never has
        uint32_t load = 0;    // that it comes by
        EspResult result = ESP_OK;
        std::string message;
        std::vector<PaintedLayer> layers;  // while it is away
    };

    float needOf(uint32_t id, const Streamed& streamed) const;
    bool stands(uint32_t id) const;
    bool uploading(const Streamed& streamed) const;
    uint64_t deviceBytes() const;
    std::set<uint32_t> wanted() const;
    // Sends away what shares the bytes that are needed least, and less than `need`. False: there is nothing.
    bool makeRoomBelow(float need);
    void sendAway(uint32_t id, Streamed& streamed);
    void endLoad(Streamed& streamed);
    // As another place of what stands already.
    void standAsIs(uint32_t id, Streamed& streamed, uint32_t like);
    EspResult mayStand(const Streamed& streamed, uint64_t hash) const;
    void stood(Streamed& streamed, uint64_t hash);

    EspContext& context_;
    EspStreamingDef def_;
    std::map<uint32_t, Streamed> surfaces_;  // by id
};

}  // namespace espalier
