// Numbers, vectors, time, materials.
#include <cmath>

#include "runtime/nodes/node_work.hpp"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;
constexpr float kMost = 1e30f;

Status makeTime(NodeWork& work) {
    work.give(float(work.time().frame), 0);
    work.give(float(work.time().frame * work.time().step), 1);
    return Done{};
}
Status makeNumber(NodeWork& work) {
    work.give(work.number("value"));
    return Done{};
}
Status makeVector(NodeWork& work) {
    work.give(glm::vec3(work.number("x"), work.number("y"), work.number("z")));
    return Done{};
}
Status makeMath(NodeWork& work) {
    const float a = work.number("a"), b = work.number("b");
    float s, c;
    switch (work.choice("does")) {
        case 0:
            work.give(a + b);
            break;
        case 1:
            work.give(a - b);
            break;
        case 2:
            work.give(a * b);
            break;
        case 3:
            if (b == 0) return Failure("", "divides by 0");
            work.give(a / b);
            break;
        case 4:
            work.give(std::min(a, b));
            break;
        case 5:
            work.give(std::max(a, b));
            break;
        case 6:
            if (b == 0) return Failure("", "divides by 0");
            work.give(a - b * std::floor(a / b));
            break;
        default:
            sinCosExact(6.28318531f * (a - std::floor(a)), s, c);
            work.give(b * s);
    }
    return Done{};
}
Status makeRound(NodeWork& work) {
    work.give(std::floor(work.number("value") + 0.5f));
    return Done{};
}
Status makeRandom(NodeWork& work) {
    const float low = work.number("low"), high = work.number("high");
    work.give(low + (high - low) * nodeRandom(work.whole("seed"), work.whole("key"), 0));
    return Done{};
}
Status makeMaterial(NodeWork& work) {
    work.give(MaterialLook{work.vector("colour"), work.number("roughness")});
    return Done{};
}

}  // namespace

std::vector<NodeKind> valueKinds() {
    const auto number = [](const char* name, float standard, const char* help = "") {
        return numberPort(name, standard, -kMost, kMost, "", help);
    };
    const MaterialLook plain;
    return {
        {"Time",
         "The frame that is shown, and its seconds.",
         {},
         {{"frame", ValueType::whole}, {"seconds", ValueType::number}},
         makeTime,
         {},
         true},
        {"Number",
         "A number that several inputs may be wired to.",
         {number("value", 0)},
         {{"value", ValueType::number}},
         makeNumber},
        {"Vector",
         "A vector of three numbers.",
         {numberPort("x", 0, -kFar, kFar, "", ""), numberPort("y", 0, -kFar, kFar, "", ""),
          numberPort("z", 0, -kFar, kFar, "", "")},
         {{"vector", ValueType::vector}},
         makeVector},
        {"Math",
         "Two numbers become one. \"wave\" is the sine of a turns, times b.",
         {{"does",
           ValueType::choice,
           "add",
           0,
           0,
           "",
           "",
           {"add", "subtract", "multiply", "divide", "least", "most", "modulo", "wave"}},
          number("a", 0),
          number("b", 1)},
         {{"value", ValueType::number}},
         makeMath},
        {"Round", "The nearest whole number.", {number("value", 0)}, {{"whole", ValueType::whole}}, makeRound},
        {"Random",
         "A number by chance. Wire its key to that of a Variant, and each variant has another.",
         {number("low", 0, "at least"), number("high", 1, "at most"),
          wholePort("key", 0, 0, 16777215, "what it follows from, with the seed"), seedPort()},
         {{"value", ValueType::number}},
         makeRandom},
        {"Material",
         "How a surface looks.",
         {{"colour", ValueType::colour, plain.colour, 0, 1, "", "linear: red, green and blue"},
          numberPort("roughness", plain.roughness, 0.05f, 1, "", "0.05 shines, 1 is matt")},
         {{"material", ValueType::material}},
         makeMaterial},
    };
}

}  // namespace espalier
