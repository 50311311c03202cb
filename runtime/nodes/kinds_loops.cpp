// Scattering, and what is made several times: variants of a shape, and passes over a geometry.
#include <algorithm>

#include "runtime/nodes/scatter.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostVariants = 4096, kMostPasses = 1000;
// Outputs of Variant.
constexpr uint32_t kIndex = 0, kShare = 1, kRandom = 2, kKey = 3, kPlace = 4;

float shareOf(const LoopPass& pass) {
    return pass.count > 1 ? float(pass.index) / float(pass.count - 1) : 0;
}

Status makeScatter(NodeWork& work) {
    Result<Scattering> scattering = Scattering::create(work);
    if (!scattering) return scattering.failure();
    return scattering->give({&work.geometry("shape"), 1}, work.whole("most"));
}

Status makeVariant(NodeWork& work) {
    const LoopPass& pass = work.pass();
    const uint32_t seed = work.whole("seed");
    work.give(float(pass.index), kIndex);
    work.give(shareOf(pass), kShare);
    work.give(nodeRandom(seed, pass.index, 0), kRandom);
    work.give(float(nodeHash(seed, pass.index, 1) >> 8), kKey);
    work.give(pass.place, kPlace);
    return Done{};
}

Status makeReplicate(NodeWork& work) {
    Result<Scattering> scattering = Scattering::create(work);
    if (!scattering) return scattering.failure();
    const uint32_t asked = work.whole("variants"), places = scattering->places();
    const uint32_t variants = asked == 0 ? places : std::min(asked, places);
    if (variants > kMostVariants)
        return Failure("", std::to_string(variants) + " variants are more than 4,096; set 'variants'");
    scattering->vary(variants);
    std::vector<glm::vec3> at;
    if (work.passesRead(kPlace))
        for (const GeometryPart& part : work.geometry("points")) {
            Result<std::vector<glm::vec3>> more = work.placesNow(part);
            if (!more) return more.failure();
            at.insert(at.end(), more->begin(), more->end());
        }
    std::vector<Geometry> shapes(variants);
    for (uint32_t v = 0; v < variants; ++v) {
        const uint32_t first = scattering->firstOf(v);
        if (first == Scattering::kNowhere) continue;
        LoopPass pass{v, variants};
        if (!at.empty()) pass.place = at[first];
        Result<const NodeValue*> shape = work.makePass(pass);
        if (!shape) return shape.failure();
        shapes[v] = std::get<Geometry>(**shape);
    }
    return scattering->give(shapes, work.whole("most"));
}

Status makePass(NodeWork& work) {
    const LoopPass& pass = work.pass();
    work.give(pass.carried ? *pass.carried : *work.wires("geometry").front());
    work.give(float(pass.index), 1);
    work.give(shareOf(pass), 2);
    return Done{};
}

Status makeRepeat(NodeWork& work) {
    LoopPass pass{0, work.whole("times")};
    for (; pass.index < pass.count; ++pass.index) {
        Result<const NodeValue*> made = work.makePass(pass);
        if (!made) return made.failure();
        pass.carried = *made;
    }
    work.give(*pass.carried);
    return Done{};
}

NodePort eachPort(const char* opener, const char* help) {
    NodePort port = wirePort("each", ValueType::whole, help);
    port.opener = opener;
    return port;
}

// The kinds' own inputs, and those of all that scatter.
std::vector<NodePort> scattering(std::vector<NodePort> ports) {
    std::ranges::move(scatterPorts(), std::back_inserter(ports));
    return ports;
}

}  // namespace

std::vector<NodeKind> scatterKinds() {
    return {
        {"Scatter",
         "A shape at each point, each sample of curves, or each vertex of a mesh. Scattered shapes may be scattered "
         "again; all together are 1,000,000 at most.",
         scattering({wirePort("points", ValueType::geometry, "where"), wirePort("shape", ValueType::geometry, "what")}),
         {{"instances", ValueType::geometry}},
         makeScatter}};
}

std::vector<NodeKind> loopKinds() {
    std::vector<NodeKind> kinds{
        {"Variant",
         "Where the nodes begin that Replicate makes once for each variant: what reads this differs from one to the "
         "next. By itself it gives the first variant.",
         {seedPort()},
         {{"index", ValueType::whole},
          {"share", ValueType::number},
          {"random", ValueType::number},
          {"key", ValueType::whole},
          {"place", ValueType::vector}},
         makeVariant},
        {"Replicate",
         "A shape at each point, as Scatter, but the shape differs: all nodes from 'each' to 'shape' are made once for "
         "each variant.",
         scattering({wirePort("points", ValueType::geometry, "where"),
                     wirePort("shape", ValueType::geometry, "what, made of nodes that read the Variant"),
                     eachPort("Variant", "the Variant that those nodes read"),
                     wholePort("variants", 8, 0, float(kMostVariants), "how many; 0: each point has one of its own")}),
         {{"instances", ValueType::geometry}},
         makeReplicate},
        {"Pass",
         "Where the nodes begin that Repeat makes several times: it gives what the pass before made, and in the first "
         "one what is wired to it.",
         {wirePort("geometry", ValueType::geometry, "what the first pass begins with")},
         {{"geometry", ValueType::geometry, true}, {"index", ValueType::whole}, {"share", ValueType::number}},
         makePass},
        {"Repeat",
         "All nodes from 'each' to 'geometry' are made several times, each time from what they gave before.",
         {wirePort("geometry", ValueType::geometry, "what a pass gives"),
          eachPort("Pass", "the Pass that it begins with"), wholePort("times", 4, 1, float(kMostPasses), "passes")},
         {{"geometry", ValueType::geometry, true}},
         makeRepeat}};
    kinds[1].repeats = "shape";
    kinds[3].repeats = "geometry";
    return kinds;
}

}  // namespace espalier
