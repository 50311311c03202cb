// Props are drawn at the level of detail that a picture's size asks for, and as its view asks.
#include "tests/render/drawn.hpp"

using namespace espalier;

namespace {

// Blades whose levels have colours of their own, in a row that leads away from the eye.
class Row : public test::Drawn {
  public:
    Row() {
        TerminalData models = test::simpleTerminals();
        models.materials.resize(kMaxLods);
        for (uint32_t l = 0; l < kMaxLods; ++l) models.materials[l].baseColor = {l == 0, l == 1, l >= 2, 1};
        for (TerminalVariant& variant : models.variants)
            for (uint32_t l = 0; l < variant.lods.size(); ++l) variant.lods[l].material = l;
        std::vector<PropPlace> places;
        for (int i = 0; i < 40; ++i)
            for (int k = 0; k < 2; ++k) places.push_back({1, {float(i % 8) - 3.5f, float(k), -float(i)}, float(k), 1});
        REQUIRE(renderer().setProps(std::move(models), std::move(places)));
        inputs.camera = {{0, 1, 4}, {0, 1, -20}, {0, 1, 0}};
    }
};

}  // namespace

TEST_CASE("after a small picture from the same place a large one has its own levels of props") {
    Row fresh, after;
    const std::vector<uint8_t> small = after.frame(160, 90);
    CHECK(after.frame(640, 360) == fresh.frame(640, 360));
    CHECK(after.frame(160, 90) == small);
}

TEST_CASE("with a layer shown props look as in the shaded view, and other views explain them") {
    Row row;
    Result<Buffer> none = Buffer::create(row.device(), "no surfaces", 256);
    REQUIRE(none);
    row.inputs.surfaces = addressOf<SurfaceBuf>(*none);
    row.inputs.layers = addressOf<LayerBuf>(*none);
    for (const bool quick : {false, true}) {
        row.inputs.look.quick = quick;
        row.inputs.look.view = ViewMode::shaded;
        const std::vector<uint8_t> shaded = row.frame(320, 180);
        row.inputs.look.view = ViewMode::layer;
        CHECK(row.frame(320, 180) == shaded);
        row.inputs.look.view = ViewMode::normals;
        CHECK(row.frame(320, 180) != shaded);
    }
}
