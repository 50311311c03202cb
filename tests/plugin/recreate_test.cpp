// A designer's work on a device that is lost again and again: after each loss the context gets another device, the call
// that failed is made again, and in the end all is as in a life without losses.
#include "tests/plugin/recreate_work.hpp"

using recreated::Fault;
using recreated::Print;
using recreated::Work;

TEST_CASE("A context whose device is lost in any submission gets another one, and has all that was made") {
    FailingDevice device;
    Print made, undone;
    {
        Work work(device);
        work.all();
        made = work.print();
        work.undoAll();
        undone = work.print();
    }
    REQUIRE(made.nodes > 100);
    REQUIRE(made.roofs != 0);
    REQUIRE(made.pattern != 0);
    REQUIRE(made.graphTriangles > 0);
    REQUIRE(made.layers != undone.layers);
    std::mt19937 random(20);
    uint32_t losses = 0;
    std::map<std::string, uint32_t> met;
    for (int lives = 0; losses < 50 && lives < 40; ++lives) {
        CAPTURE(lives);
        Work work(device);
        const auto arm = [&] { device.failAt(random() % 24, Fault::LostAtSubmit); };
        work.lost = [&] {
            CHECK(device.failed() == "vkQueueSubmit2");
            ++losses;
            work.renew();
            arm();
        };
        arm();
        work.all();
        CHECK(work.print() == made);
        work.undoAll();
        CHECK(work.print() == undone);
        device.heal();
        // Once more without a loss: as a host does that goes to another GPU.
        work.lost = [] { FAIL("the device was lost"); };
        work.renew();
        work.grow();
        CHECK(work.print() == undone);
    }
    MESSAGE(losses << " losses");
    CHECK(losses >= 50);
}

TEST_CASE("a context waits for its device until all can be read again, and says what can't") {
    const std::string copy = std::string(ESPALIER_SQUARE) + ".gone.glb", aside = copy + ".aside";
    std::filesystem::copy_file(ESPALIER_SQUARE, copy, std::filesystem::copy_options::overwrite_existing);
    FailingDevice device;
    Work work(device);
    work.all();
    const EspTransform place = recreated::at(0, 5);
    EspSurface fourth{};
    REQUIRE(espLoadSurface(work.context, copy.c_str(), &place, &fourth) == ESP_OK);
    work.grow();
    const Print made = work.print();
    const float reach = made.reach;
    work.lose();
    REQUIRE(espSetParam(work.context, work.grammar, "reach", &reach, 1) == ESP_OK);
    std::filesystem::rename(copy, aside);
    device.renew();
    for (int tries = 0; tries < 2; ++tries) {
        CHECK(work.recreate() == ESP_IO_FAILED);
        CHECK_MESSAGE(std::string(espLastError(work.context)).find(copy) != std::string::npos,
                      espLastError(work.context));
        CHECK(espUpdate(work.context) == ESP_DEVICE_LOST);
        CHECK(espMoveSurface(work.context, fourth, &place) == ESP_DEVICE_LOST);
        EspStats stats{};
        CHECK(espReadStats(work.context, &stats) == ESP_DEVICE_LOST);
        CHECK(std::string(espLastError(work.context)).find("espRecreate") != std::string::npos);
    }
    std::filesystem::copy_file(std::string(ESPALIER_CONTENT) + "/vase.surface.glb", copy);
    CHECK(work.recreate() == ESP_INVALID_CONTENT);
    CHECK_MESSAGE(std::string(espLastError(work.context)).find("isn't the file any more") != std::string::npos,
                  espLastError(work.context));
    std::filesystem::rename(aside, copy);
    REQUIRE_MESSAGE(work.recreate() == ESP_OK, espLastError(work.context));
    device.dropOld();
    work.grow();
    CHECK(work.print() == made);
    std::filesystem::remove(copy);
}

TEST_CASE("memory that runs out while a context gets another device costs one more try") {
    FailingDevice device;
    Work work(device);
    work.all();
    const Print made = work.print();
    uint32_t failures = 0;
    for (uint32_t at = 0;; at += 37) {
        CAPTURE(at);
        device.renew();
        device.failAt(at, Fault::OutOfMemory);
        const EspResult result = work.recreate();
        const bool failed = !device.failed().empty();
        device.heal();
        CHECK((result == ESP_OK || result == ESP_OUT_OF_MEMORY || result == ESP_NO_DEVICE));
        failures += result != ESP_OK;
        if (result != ESP_OK) REQUIRE_MESSAGE(work.recreate() == ESP_OK, espLastError(work.context));
        device.dropOld();
        work.grow();
        REQUIRE(work.print() == made);
        if (!failed) break;
    }
    CHECK(failures > 5);
}

TEST_CASE("paint that memory was too short to copy at a stroke's end is copied by a later update") {
    FailingDevice device;
    Work work(device);
    work.loadAll();
    work.plantAll();
    uint32_t failures = 0;
    for (uint32_t at = 0;; ++at) {
        CAPTURE(at);
        const EspStroke stroke = work.open("damp", ESP_BRUSH_PAINT, .2f);
        work.dab(stroke, .2f + .01f * float(at), .6f);
        device.failAt(at, Fault::OutOfMemory);
        REQUIRE(espEndStroke(work.context, stroke) == ESP_OK);
        const bool failed = !device.failed().empty();
        device.heal();
        failures += failed;
        work.strokes.push_back(stroke);
        work.grow();
        const auto painted = work.layers();
        work.renew();
        work.grow();
        REQUIRE(work.layers() == painted);
        REQUIRE(espSwapStroke(work.context, stroke) == ESP_OK);
        const auto undone = work.layers();
        CHECK(undone != painted);
        work.renew();
        REQUIRE(work.layers() == undone);
        REQUIRE(espSwapStroke(work.context, stroke) == ESP_OK);
        REQUIRE(work.layers() == painted);
        if (!failed) break;
    }
    CHECK(failures > 5);
}

namespace {

using Layers = std::vector<std::vector<float>>;

Layers masks(Work& work) {
    Layers all;
    for (const EspSurface of : {work.surface, work.other}) {
        uint32_t side = 0;
        work.take([&] { return espReadLayer(work.context, of, "mask", nullptr, &side); });
        std::vector<float>& texels = all.emplace_back(size_t(side) * side);
        work.take([&] { return espReadLayer(work.context, of, "mask", texels.data(), &side); });
    }
    return all;
}

// Paints over the border of two surfaces and fills a layer, losing the device at one submission of the stroke's end or
// of the filling. Tells whether it was lost, what is painted then, and what once all is undone.
struct Border {
    bool lost = false;
    Layers painted, undone;
    Border(FailingDevice& device, int64_t submission, bool fills) {
        Work work(device);
        const EspTransform beside = recreated::at(1, 0);
        work.take([&] { return espLoadSurface(work.context, ESPALIER_SQUARE, nullptr, &work.surface); });
        work.take([&] { return espLoadSurface(work.context, ESPALIER_SQUARE, &beside, &work.other); });
        const EspStroke ground = work.open("mask", ESP_BRUSH_PAINT, .3f);
        work.dab(ground, .9f, .5f);
        work.end(ground);
        EspStroke stroke = work.open("mask", ESP_BRUSH_SMOOTH, .25f);
        work.dab(stroke, .95f, .5f);
        work.dab(stroke, 1.05f, .45f);
        work.lost = [&] { lost = true, work.renew(); };
        if (!fills) device.failAt(uint32_t(submission), Fault::LostAtSubmit);
        work.end(stroke);
        if (fills) {
            const Layers ended = masks(work);
            work.lost = [&] {
                lost = true;
                work.renew();
                CHECK(masks(work) == ended);
            };
            device.failAt(uint32_t(submission), Fault::LostAtSubmit);
            work.take([&] { return espFillLayer(work.context, "mask", .75f, &stroke); });
            work.strokes.push_back(stroke);
        }
        device.heal();
        painted = masks(work);
        work.lost = [] { FAIL("the device was lost"); };
        work.renew();  // what the host has kept is the same
        CHECK(masks(work) == painted);
        work.undoAll();
        undone = masks(work);
        work.renew();
        CHECK(masks(work) == undone);
    }
};

}  // namespace

TEST_CASE("a stroke's end and a filling that lose the device at any submission have done nothing, or all") {
    FailingDevice device;
    for (const bool fills : {false, true}) {
        CAPTURE(fills);
        const Border whole(device, 1000000, fills);
        CHECK(!whole.lost);
        CHECK(whole.painted != whole.undone);
        uint32_t losses = 0;
        for (uint32_t at = 0; at < 100; ++at) {
            CAPTURE(at);
            const Border border(device, at, fills);
            if (!border.lost) break;
            ++losses;
            CHECK(border.painted == whole.painted);
            CHECK(border.undone == whole.undone);
        }
        CHECK(losses >= 3);
    }
}
