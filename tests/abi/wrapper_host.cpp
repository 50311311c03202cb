// A host in C++ that uses espalier.hpp.
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>

#include "plugin_api/espalier.hpp"

namespace {

void check(bool good, int line) {
    if (good) return;
    std::fprintf(stderr, "wrapper_host.cpp:%d: failed\n", line);
    std::exit(1);
}
#define CHECK(condition) check(condition, __LINE__)

size_t asked = 0;  // for memory, by whoever is in this process

constexpr const char* kIvy =
    "Ivy -> Stem\n"
    "Stem : arc >= 0.6 -> NULL\n"
    "Stem -> Marching(0.05, rand(-0.3, 0.3), true) {Stem, Wood}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n";

void failures(esp::Context& context) {
    const auto none = context.loadSurface("no/such.glb");
    CHECK(!none && none.error().code == ESP_IO_FAILED);
    CHECK(none.error().message.find("no/such.glb") != std::string::npos);
    const auto text = context.compile(esp::grammarDef("bad", "Ivy -> Marching("));
    CHECK(!text && text.error().code == ESP_INVALID_CONTENT);
}

}  // namespace

void* operator new(size_t size) {
    ++asked;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}

int main(int argc, char** argv) {
    CHECK(argc == 2);
    EspContextDef def = esp::defaults<EspContextDef>();
    def.skipSelfCheck = 1;
    def.log = [](void*, EspLogLevel, const char*) {};
    esp::Result<esp::Context> made = esp::Context::create(def);
    CHECK(made.has_value());
    esp::Context context = std::move(*made);
    failures(context);
    const size_t before = asked;
    esp::Surface wall = context.loadSurface(argv[1]).value();
    CHECK(asked > before + 50);  // the library's memory is the program's
    esp::Grammar ivy = context.compile(esp::grammarDef("ivy", kIvy)).value();
    EspSeedDef def2 = esp::defaults<EspSeedDef>();
    def2.grammar = ivy.id();
    def2.position[0] = def2.position[1] = .2f;
    def2.direction[1] = 1;
    {
        esp::Seed seed = context.plant(def2).value();
        esp::Seed moved = std::move(seed);
        CHECK(!seed && moved);
        CHECK(espSeedCount(context.get()) == 1);
        CHECK(context.update().has_value());
        CHECK(context.stats().value().nodes > 10);
    }
    CHECK(espSeedCount(context.get()) == 0);  // it went with its owner
    (void)context.plant(def2).value().release();
    CHECK(espSeedCount(context.get()) == 1);  // nobody's: it stays
    CHECK(context.update().has_value());

    // A def that is copied leads to the copy's camera.
    esp::DrawDef draw;
    draw.width = draw.height = 32;
    draw.camera = esp::frameAll(context.get());
    esp::DrawDef far = draw;
    far.camera.fovY = 3;
    const EspDrawDef& c = far;
    CHECK(c.camera == &far.camera && c.look == &far.look && draw.camera.fovY != 3);
    CHECK(context.draw(draw).has_value());
    far.width = 0;
    CHECK(context.draw(far).error().code == ESP_INVALID_ARGUMENT);
    std::printf("the interface for C++: all checks passed\n");
    return 0;
}
