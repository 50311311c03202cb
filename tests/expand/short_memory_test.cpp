// Edits that memory runs short in: what grew before stands, in buffers that are there, and grows on when there is some.
#include <doctest/doctest.h>

#include <string_view>

#include "tests/expand/session.hpp"
#include "tests/support/driver_between.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

constexpr uint32_t kPlenty = ~0u;

// A host's memory that gives growth so many more buffers, then none.
class ScantMemory : public MemorySource {
  public:
    explicit ScantMemory(MemorySource& source) : source_(source) {}
    Result<MemoryBlock> allocate(const MemoryRequest& request) override {
        const std::string_view name = request.name;
        if (left != kPlenty && (name.starts_with("growth") || name.starts_with("regrowth"))) {
            refused |= left == 0;
            if (left == 0) return Failure(request.name, "none left");
            --left;
        }
        return source_.allocate(request);
    }
    void free(const MemoryBlock& block) noexcept override { source_.free(block); }
    uint64_t bytesUsed() const override { return source_.bytesUsed(); }
    uint64_t bytesReserved() const override { return source_.bytesReserved(); }
    uint32_t left = kPlenty;
    bool refused = false;

  private:
    MemorySource& source_;
};

// Growth that is edited on such a device.
struct Scant {
    TestDevice real;
    ScantMemory memory{real.device().memory()};
    std::unique_ptr<Device> device;
    Scene scene = Scene::baked(ball());
    std::unique_ptr<Growth> growth;
    GrowthChanges changes;

    explicit Scant(bool native) {
        HostDevice host = test::hostOf(real.device());
        host.memory = &memory;
        Result<std::unique_ptr<Device>> adopted = Device::adopt(host);
        REQUIRE(adopted);
        device = std::move(*adopted);
        Result<std::unique_ptr<Growth>> made = Growth::create(*device, {64, 64, 64, 64, 64});
        REQUIRE(made);
        growth = std::move(*made);
        scene.addGrammar(kGuided);
        scene.native = native;
        scene.changes = &changes;
    }
    Status grow() { return scene.grow(*device, *growth); }
    // With so many buffers at most.
    Status growWith(uint32_t buffers) {
        memory.refused = false;
        memory.left = buffers;
        Status grown = grow();
        memory.left = kPlenty;
        return grown;
    }
    // Forty plants, and no more room than such growth asks for.
    void begin() {
        scene.clearSeeds();
        scene.plantMany(40, 0, 1);
        changes.everything = true;
        for (int set = 0; set < 2; ++set) {
            REQUIRE(grow());
            growth->trim();
        }
        changes.everything = false;
    }
    void plantQuarter() {
        const uint32_t seeds = uint32_t(scene.seeds().size());
        scene.plantMany(seeds / 4, 0, seeds);
    }
};

// What emission follows lies in buffers that are there.
void checkReadable(const GrowthView& view) {
    const auto holds = [](const Buffer* buffer, uint32_t numbers) {
        return !buffer || (buffer->address() != 0 && buffer->size() / 4 >= numbers);
    };
    CHECK(view.nodeBuffer->size() / sizeof(Node) >= view.nodeCount);
    CHECK(view.leafBuffer->size() / sizeof(Leaf) >= view.leafCount);
    CHECK(holds(view.touched, view.nodeCount));
    CHECK(holds(view.moved.nodes, view.moved.nodesBefore));
    CHECK(holds(view.moved.leaves, view.moved.leavesBefore));
}

}  // namespace

TEST_CASE("where an edit finds no room and there is no memory for more, what stood can be looked at and grows later") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Scant s(native);
        // So many edits that nodes have moved to more room twice, in the last of them for the second time.
        uint32_t edits = 0;
        s.begin();
        for (uint32_t moves = 0; moves < 2; ++edits) {
            REQUIRE(edits < 12);
            const uint64_t room = s.growth->view().nodeBuffer->size();
            s.plantQuarter();
            REQUIRE(s.grow());
            moves += s.growth->view().moved.nodes && s.growth->view().nodeBuffer->size() > room ? 1 : 0;
        }
        const uint64_t hash = s.growth->stats().hash;

        uint32_t failures = 0;
        for (uint32_t buffers = 0;; ++buffers) {
            REQUIRE(buffers < 64);
            CAPTURE(buffers);
            s.begin();
            for (uint32_t edit = 1; edit < edits; ++edit) {
                s.plantQuarter();
                REQUIRE(s.grow());
            }
            const uint64_t before = s.growth->stats().hash;
            s.plantQuarter();
            const Status grown = s.growWith(buffers);
            checkReadable(s.growth->view());
            if (!grown) CHECK(s.growth->stats().hash == before);
            failures += grown ? 0 : 1;
            REQUIRE(s.grow());
            checkReadable(s.growth->view());
            CHECK(s.growth->stats().hash == hash);
            if (!s.memory.refused) break;
        }
        CHECK(failures > 3);
    }
}

TEST_CASE("a frozen plant that an edit has put in is gone again when memory runs short") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Scant s(native);
        s.begin();
        Result<GrowthRecords> records = s.growth->read();
        REQUIRE(records);
        const GrowthStats before = s.growth->stats();
        const uint64_t key = s.scene.seeds()[3].key;
        s.scene.seeds().erase(s.scene.seeds().begin() + 3);
        s.scene.frozen = {{key, std::make_shared<PlantRecords>(plantOf(*records, 3))}};
        s.changes.frozen = {key};  // what has grown there isn't asked
        uint32_t failures = 0;
        for (uint32_t buffers = 0;; ++buffers) {
            REQUIRE(buffers < 64);
            CAPTURE(buffers);
            const Status grown = s.growWith(buffers);
            const GrowthStats now = s.growth->stats();
            CHECK(now.hash == before.hash);
            CHECK(now.nodes == before.nodes);
            CHECK(now.leaves == before.leaves);
            CHECK(now.chunks == before.chunks);
            CHECK(now.branches == before.branches);
            Result<GrowthRecords> stood = s.growth->read();
            REQUIRE(stood);
            CHECK(stood->nodes.size() == before.nodes);
            CHECK(stood->leaves.size() == before.leaves);
            if (grown) break;
            failures += 1;
        }
        CHECK(failures > 1);
    }
}
