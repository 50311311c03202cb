// Modifiers: each appends a step to the program that geometry carries. Nothing is copied, and what is scattered stays
// so.
#include "runtime/core/hash.hpp"
#include "runtime/nodes/function_text.hpp"
#include "runtime/nodes/node_work.hpp"
#include "runtime/surface/picture.hpp"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;  // metres
constexpr uint32_t kMostPictureSide = 4096;

NodePort geometryPort() {
    return wirePort("geometry", ValueType::geometry, "what it acts on");
}
NodePort centrePort() {
    return vectorPort("centre", glm::vec3(0), -kFar, kFar, "m", "the place that stays");
}
NodePort axisPort(const char* help) {
    return vectorPort("axis", glm::vec3(0, 1, 0), -1000, 1000, "", help);
}

Status append(NodeWork& work, const DeformOp& op, const BlockRef& refersTo = nullptr) {
    Geometry out = work.geometry("geometry");
    for (GeometryPart& part : out) {
        if (part.program.size() >= kMostDeforms) return Failure("", "more than 64 steps act on one geometry");
        part.program.push_back(op);
        if (refersTo) part.held.push_back(refersTo);
    }
    work.give(std::move(out));
    return Done{};
}

void put(DeformOp& op, uint32_t first, glm::vec3 v) {
    for (uint32_t i = 0; i < 3; ++i) op.a[first + i] = v[int(i)];
}
// False: it has no length.
bool direction(NodeWork& work, const char* port, glm::vec3& out) {
    const glm::vec3 v = work.vector(port);
    if (!(dot3(v, v) > 1e-12f)) return false;
    out = unit3(v);
    return true;
}
Failure noLength(const char* port) {
    return Failure("", std::string("'") + port + "' is (0, 0, 0), which is no direction");
}
DeformOp opOf(uint32_t kind) {
    DeformOp op{};
    op.kind = kind;
    return op;
}

Status makeTransform(NodeWork& work) {
    DeformOp op = opOf(kDeformMove);
    const glm::vec3 move = work.vector("move"), turn = work.vector("turn"), scale = work.vector("scale");
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 column{0};
        column[axis] = scale[axis];
        column = turnedAbout(column, {1, 0, 0}, turn.x);
        column = turnedAbout(column, {0, 1, 0}, turn.y);
        column = turnedAbout(column, {0, 0, 1}, turn.z);
        for (int row = 0; row < 3; ++row) op.a[row * 4 + axis] = column[row];
    }
    for (int row = 0; row < 3; ++row) op.a[row * 4 + 3] = move[row];
    return append(work, op);
}
Status makeSpherify(NodeWork& work) {
    DeformOp op = opOf(kDeformSpherify);
    put(op, 0, work.vector("centre"));
    op.a[3] = work.number("radius");
    op.a[4] = work.number("amount");
    return append(work, op);
}
Status makeTwist(NodeWork& work) {
    DeformOp op = opOf(kDeformTwist);
    glm::vec3 axis;
    if (!direction(work, "axis", axis)) return noLength("axis");
    put(op, 0, work.vector("centre"));
    put(op, 3, axis);
    op.a[6] = work.number("angle");
    return append(work, op);
}
Status makeBend(NodeWork& work) {
    DeformOp op = opOf(kDeformBend);
    glm::vec3 axis, towards;
    if (!direction(work, "axis", axis)) return noLength("axis");
    if (!direction(work, "towards", towards)) return noLength("towards");
    towards -= axis * dot3(axis, towards);
    if (!(dot3(towards, towards) > 1e-8f)) return Failure("", "'towards' lies along 'axis'");
    put(op, 0, work.vector("centre"));
    put(op, 3, axis);
    put(op, 6, unit3(towards));
    op.a[9] = work.number("angle");
    return append(work, op);
}
Status makeNoise(NodeWork& work, uint32_t kind) {
    DeformOp op = opOf(kind);
    op.a[0] = work.number("amount");
    op.a[1] = work.number("scale");
    put(op, 2, work.vector("offset"));
    op.seed = work.whole("seed");
    return append(work, op);
}
Status makeNoise(NodeWork& work) {
    return makeNoise(work, kDeformNoise);
}

// The grey of a picture that was decoded last, and where its texels lie.
struct KeptPicture : NodeMemory {
    uint64_t file = 0;  // hash of its bytes
    BlockRef texels;
    uint32_t width = 0, height = 0;
};
Status makeDisplace(NodeWork& work) {
    if (work.text("picture").empty()) return makeNoise(work, kDeformDisplace);
    Result<NodeFile> file = work.file("picture");
    if (!file) return file.failure();
    const uint64_t hash = hashBytes(file->bytes, 0);
    std::unique_ptr<KeptPicture> kept = work.takeMemory<KeptPicture>();
    if (!kept || kept->file != hash) {
        kept = std::make_unique<KeptPicture>();
        Result<UvPicture> grey = decodeGrey(file->bytes, work.text("picture"), kMostPictureSide);
        if (!grey) return Failure("", grey.failure().text());
        Result<NodeWork::Room> sent = work.sent("picture", grey->texels);
        if (!sent) return sent.failure();
        kept->file = hash;
        kept->texels = sent->block;
        kept->width = grey->width;
        kept->height = grey->height;
    }
    DeformOp op = opOf(kDeformPicture);
    op.sizes = kept->texels->as<FloatBuf>();
    op.row = kept->width;
    op.used = kept->height;
    op.a[0] = work.number("amount");
    op.a[1] = work.number("level");
    op.a[2] = work.number("scale");
    put(op, 3, work.vector("offset"));
    const BlockRef texels = kept->texels;
    if (Status appended = append(work, op, texels); !appended) return appended;
    work.keep(std::move(kept));
    return Done{};
}
Status makeWave(NodeWork& work) {
    DeformOp op = opOf(kDeformWave);
    glm::vec3 along, travel;
    if (!direction(work, "direction", along)) return noLength("direction");
    if (!direction(work, "travel", travel)) return noLength("travel");
    op.a[0] = work.number("amount");
    put(op, 1, along);
    put(op, 4, travel * (1 / work.number("length")));
    op.a[7] = -work.number("phase");
    return append(work, op);
}

Status makeFunction(NodeWork& work) {
    Result<std::vector<uint32_t>> code = compileFunction({work.text("x"), work.text("y"), work.text("z")});
    if (!code) return code.failure();
    Result<NodeWork::Room> sent = work.sent("function", *code);
    if (!sent) return sent.failure();
    DeformOp op = opOf(kDeformFunction);
    op.normals = sent->block->as<UintBuf>();
    op.row = uint32_t(code->size());
    put(op, 0, {work.number("a"), work.number("b"), work.number("c")});
    return append(work, op, sent->block);
}

Status makeSetMaterial(NodeWork& work) {
    Geometry out = work.geometry("geometry");
    for (GeometryPart& part : out) part.material = work.material("material");
    work.give(std::move(out));
    return Done{};
}
Status makeJoin(NodeWork& work) {
    constexpr size_t kMostParts = 4096;
    Geometry out;
    for (const NodeValue* value : work.wires("parts")) {
        const Geometry& parts = std::get<Geometry>(*value);
        out.insert(out.end(), parts.begin(), parts.end());
        if (out.size() > kMostParts) return Failure("", "joins more than 4,096 parts");
    }
    work.give(std::move(out));
    return Done{};
}
Status makeSwitch(NodeWork& work) {
    const auto wires = work.wires("choices");
    if (wires.empty()) return Failure("", "has nothing to choose from: wire 'choices'");
    work.give(*wires[std::min<size_t>(work.whole("index"), wires.size() - 1)]);
    return Done{};
}

}  // namespace

std::vector<NodeKind> modifierKinds() {
    const std::vector<NodeOutput> same{{"geometry", ValueType::geometry, true}};
    const auto amount = [](float standard, const char* help) {
        return numberPort("amount", standard, -kFar, kFar, "m", help);
    };
    const auto noise = [&](const char* name, const char* help, Status (*make)(NodeWork&)) {
        return NodeKind{name,
                        help,
                        {geometryPort(), amount(0.1f, "how far at most"),
                         numberPort("scale", 1, 0, kFar, "1/m", "features along a metre"),
                         vectorPort("offset", glm::vec3(0), -kFar, kFar, "",
                                    "moves the noise, in features; wire a vector made of time to let it flow"),
                         seedPort()},
                        same,
                        make,
                        {"nodes/deform.comp"}};
    };
    NodeKind displace =
        noise("Displace",
              "Moves each vertex of a mesh along its normal, by smooth noise or by the grey of a picture. "
              "A picture repeats, and lies over the mesh from three sides.",
              makeDisplace);
    displace.inputs.push_back(
        {"picture", ValueType::file, "", 0, 0, "",
         "instead of noise: a PNG or JPEG beside the graph's own file; with it a feature is a picture"});
    displace.inputs.push_back(numberPort("level", 0.5f, 0, 1, "", "of a picture: the grey that moves nothing"));
    NodePort parts = wirePort("parts", ValueType::geometry, "wires to all that is joined");
    parts.many = parts.optional = true;
    NodePort choices = wirePort("choices", ValueType::geometry, "wires to what is chosen from");
    choices.many = choices.optional = true;
    return {
        {"Transform",
         "Scales, then turns about x, y and z, then moves.",
         {geometryPort(), vectorPort("move", glm::vec3(0), -kFar, kFar, "m", ""),
          vectorPort("turn", glm::vec3(0), -1000, 1000, "rad", "about each axis"),
          vectorPort("scale", glm::vec3(1), -kFar, kFar, "", "along each axis")},
         same,
         makeTransform,
         {"nodes/deform.comp"}},
        {"Spherify",
         "Moves each place towards a sphere: with an amount of 1 onto it.",
         {geometryPort(), centrePort(), numberPort("radius", 1, 0, kFar, "m", ""),
          numberPort("amount", 1, -10, 10, "", "0: stays; 1: lies on the sphere")},
         same,
         makeSpherify,
         {"nodes/deform.comp"}},
        {"Twist",
         "Turns about an axis, the more the farther along it.",
         {geometryPort(), numberPort("angle", 1, -1000, 1000, "rad/m", "along a metre of the axis"),
          axisPort("what it turns about"), centrePort()},
         same,
         makeTwist,
         {"nodes/deform.comp"}},
        {"Bend",
         "Bends an axis into a circle.",
         {geometryPort(), numberPort("angle", 0.5f, -1000, 1000, "rad/m", "along a metre of the axis"),
          axisPort("what is bent"),
          vectorPort("towards", glm::vec3(1, 0, 0), -1000, 1000, "", "the side to which it bends"), centrePort()},
         same,
         makeBend,
         {"nodes/deform.comp"}},
        noise("Noise", "Moves each place by smooth noise, in all directions.", makeNoise),
        displace,
        {"Wave",
         "Moves places in one direction by a wave that travels in another.",
         {geometryPort(), amount(0.1f, "its height"),
          vectorPort("direction", glm::vec3(0, 1, 0), -1000, 1000, "", "in which places move"),
          vectorPort("travel", glm::vec3(1, 0, 0), -1000, 1000, "", "in which the wave travels"),
          numberPort("length", 1, 1e-6f, kFar, "m", "from wave to wave"),
          numberPort("phase", 0, -kFar, kFar, "turns", "how many waves have gone by")},
         same,
         makeWave,
         {"nodes/deform.comp"}},
        {"Function",
         "Moves each place to where three expressions of it lead. They know x, y, z, the inputs a, b, c, numbers, + - "
         "* /, "
         "min, max, mod, abs, floor, sqrt, sin and cos of radians, and noise(u, v, w) of -1 to 1.",
         {geometryPort(),
          {"x", ValueType::text, "x"},
          {"y", ValueType::text, "y"},
          {"z", ValueType::text, "z"},
          numberPort("a", 0, -kFar, kFar, "", "wire numbers to these, such as time"),
          numberPort("b", 0, -kFar, kFar, "", ""),
          numberPort("c", 0, -kFar, kFar, "", "")},
         same,
         makeFunction,
         {"nodes/deform.comp"}},
        {"SetMaterial",
         "The same geometry with a material.",
         {geometryPort(), wirePort("material", ValueType::material, "")},
         same,
         makeSetMaterial},
        {"Join", "All that is wired to it, as one.", {parts}, {{"geometry", ValueType::geometry}}, makeJoin},
        {"Switch",
         "One of all that is wired to it.",
         {wholePort("index", 0, 0, 4096, "which: 0 is the first; beyond the last it is the last"), choices},
         {{"geometry", ValueType::geometry}},
         makeSwitch},
    };
}

}  // namespace espalier
