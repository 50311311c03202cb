// Memory, deferred destruction, uploads, images and drawing.
#include "runtime/gpu/retire.hpp"

#ifdef __linux__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cstdlib>

#include "tests/gpu/gpu_test.hpp"

using namespace espalier;

namespace {

VkPhysicalDeviceMemoryProperties memoryOf(const Device& device) {
    VkPhysicalDeviceMemoryProperties properties{};
    const auto ask = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        device.getInstanceProcAddr()(device.instance(), "vkGetPhysicalDeviceMemoryProperties"));
    REQUIRE(bool(ask));
    ask(device.physicalDevice(), &properties);
    return properties;
}

}  // namespace

TEST_CASE("a buffer that is larger than the GPU is refused") {
    TestDevice t;
    for (uint64_t size : {1ull << 45, 1ull << 62, ~0ull}) {
        Result<Buffer> buffer = Buffer::create(t.device, "absurd", size);
        REQUIRE_FALSE(buffer);
        CHECK(buffer.failure().text().find("absurd: out of GPU memory") != std::string::npos);
    }
    ImageDesc desc;
    desc.name = "wide";
    desc.width = 1u << 30;
    REQUIRE_FALSE(Image::create(t.device, desc));
    CHECK_FALSE(t.device.lost());
}

TEST_CASE("empty buffers are fine") {
    TestDevice t;
    Buffer empty = must(makeBuffer(t.device, "empty", std::vector<uint32_t>()));
    CHECK(empty.size() == 0);
    CHECK(empty.address() != 0);
    CHECK(must(readBuffer(t.device, empty, 0, 0)).empty());
}

TEST_CASE("memory is pooled, aligned, disjoint and comes back") {
    TestDevice t;
    MemorySource& memory = t.device.memory();
    const uint64_t used = memory.bytesUsed();
    {
        std::vector<Buffer> buffers;
        for (int i = 0; i < 300; ++i) {
            const std::vector<uint32_t> words(size_t(1 + i * i), uint32_t(i));
            buffers.push_back(must(makeBuffer(t.device, "piece", words)));
            if (i % 3 == 0) buffers.erase(buffers.begin() + i / 5);
            t.device.collect();
        }
        for (const Buffer& b : buffers) {
            const std::vector<uint32_t> got = must(readVector<uint32_t>(t.device, b, 0, b.size() / 4));
            CHECK(b.address() % 4 == 0);
            bool one = true;
            for (uint32_t word : got) one = one && uint64_t(word) * word + 1 == b.size() / 4;
            CHECK(one);
        }
        CHECK(memory.bytesReserved() <= 2 * (64ull << 20));
    }
    REQUIRE(t.device.waitIdle());
    CHECK(memory.bytesUsed() == used);
    const uint64_t reserved = memory.bytesReserved();
    for (int i = 0; i < 20; ++i) {  // large ones go round in one block
        (void)must(Buffer::create(t.device, "large", 40ull << 20));
        t.device.collect();
    }
    CHECK(memory.bytesReserved() == reserved + (40ull << 20));
}

TEST_CASE("of memory that nothing lies in any more no more is kept than was said") {
    TestDevice t;
    const VkPhysicalDeviceMemoryProperties properties = memoryOf(t.device);
    constexpr uint64_t kPiece = 20ull << 20, kKept = 60ull << 20;
    const auto memory = makePooledMemory(t.device.vk(), t.device.handle(), properties, false, kKept);
    MemoryRequest request;
    request.requirements = {kPiece, 64, ~0u};
    request.use = BufferUse::upload;
    request.name = "large";
    std::vector<MemoryBlock> pieces;
    for (int i = 0; i < 8; ++i) pieces.push_back(must(memory->allocate(request)));
    CHECK(memory->bytesUsed() == 8 * kPiece);
    CHECK(memory->bytesReserved() == 8 * kPiece);
    for (const MemoryBlock& piece : pieces) memory->free(piece);
    CHECK(memory->bytesUsed() == 0);
    CHECK(memory->bytesReserved() == kKept);
}

TEST_CASE("memory that nothing lies in is given back when asked for") {
    TestDevice t;
    const VkPhysicalDeviceMemoryProperties properties = memoryOf(t.device);
    constexpr uint64_t kPiece = 20ull << 20;
    const auto memory = makePooledMemory(t.device.vk(), t.device.handle(), properties, false);
    MemoryRequest request;
    request.requirements = {kPiece, 64, ~0u};
    request.use = BufferUse::upload;
    request.name = "large";
    const MemoryBlock kept = must(memory->allocate(request)), other = must(memory->allocate(request));
    request.requirements.size = 1 << 20;
    const MemoryBlock small = must(memory->allocate(request));
    memory->free(other);
    memory->free(small);
    CHECK(memory->bytesReserved() > 2 * kPiece);
    memory->trim();
    CHECK(memory->bytesUsed() == kPiece);
    CHECK(memory->bytesReserved() == kPiece);
    std::memset(kept.mapped, 1, kPiece);
    memory->free(kept);
    memory->trim();
    CHECK(memory->bytesReserved() == 0);
    (void)must(memory->allocate(request));
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
namespace {

using Malloced = std::unique_ptr<void, decltype(&std::free)>;

// A hole in glibc's heap of pages that were in use, where the next large allocation goes. It ends at what is returned,
// or it would be the heap's end and go.
Malloced leaveHole(size_t bytes) {
    constexpr size_t kPiece = 1 << 20;
    (void)mallopt(M_MMAP_THRESHOLD, 32 << 20);
    std::vector<void*> pieces(bytes / kPiece);
    for (void*& piece : pieces) std::memset(piece = std::malloc(kPiece), 1, kPiece);
    Malloced after(std::malloc(kPiece), std::free);
    for (void* piece : pieces) std::free(piece);
    (void)mallopt(M_MMAP_THRESHOLD, 1 << 20);
    return after;
}

uintptr_t pageBytes() {
    return uintptr_t(sysconf(_SC_PAGESIZE));
}

size_t residentBytes(std::byte* from, size_t bytes) {
    const uintptr_t size = pageBytes(), first = (reinterpret_cast<uintptr_t>(from) + size - 1) / size * size;
    std::vector<unsigned char> pages((bytes - size) / size);
    REQUIRE(mincore(reinterpret_cast<void*>(first), pages.size() * size, pages.data()) == 0);
    return size_t(std::ranges::count_if(pages, [](unsigned char page) { return (page & 1) != 0; })) * size;
}

}  // namespace

TEST_CASE("what a software device takes costs nothing until it is touched, whatever the process had there before") {
    TestDevice t;
    if (!t.device.info().cpu) {
        MESSAGE("other devices' memory isn't the process's own");
        return;
    }
    constexpr uint64_t kSize = 40ull << 20;
    const auto memory = makePooledMemory(t.device.vk(), t.device.handle(), memoryOf(t.device), true);
    const Malloced after = leaveHole(96 << 20);
    for (bool image : {false, true}) {
        CAPTURE(image);
        MemoryRequest request;
        request.requirements = {kSize, 64, ~0u};
        request.image = image;
        request.name = "room to spare";
        const MemoryBlock block = must(memory->allocate(request));
        void* at = block.mapped;
        CHECK((at == nullptr) == image);
        if (image)
            REQUIRE(t.device.vk().vkMapMemory(t.device.handle(), block.memory, 0, VK_WHOLE_SIZE, 0, &at) == VK_SUCCESS);
        CHECK(residentBytes(static_cast<std::byte*>(at), kSize) == 0);
        std::memset(at, 1, kSize / 2);
        CHECK(residentBytes(static_cast<std::byte*>(at), kSize) >= kSize / 2 - pageBytes());
        memory->free(block);
    }
}
#endif

TEST_CASE("the retire queue waits for every recording that was begun before") {
    RetireQueue queue;
    int destroyed = 0;
    const uint64_t a = queue.beginRecording(), b = queue.beginRecording(), c = queue.beginRecording();
    queue.add([&] { ++destroyed; });
    const uint64_t later = queue.beginRecording();
    queue.recordingSubmitted(later, 1);  // begun later, submitted first
    queue.recordingSubmitted(b, 2);
    queue.recordingIntoHost(c, 9);
    queue.collect(2, 8);
    CHECK(destroyed == 0);
    queue.recordingDiscarded(a);
    queue.collect(2, 8);
    CHECK(destroyed == 0);
    queue.collect(2, 9);
    CHECK(destroyed == 1);
    queue.add([&] { ++destroyed; });
    queue.collect(2, 9);
    CHECK(destroyed == 2);  // nothing runs
}

TEST_CASE("a host's frame has finished when what was submitted behind it has") {
    RetireQueue queue;
    int destroyed = 0;
    const uint64_t first = queue.beginRecording();
    queue.recordingIntoHost(first, 1);
    queue.add([&] { ++destroyed; });
    queue.collect(4, 0);  // what was submitted before says nothing
    CHECK(destroyed == 0);
    queue.hostSubmitted(5);
    const uint64_t second = queue.beginRecording();
    queue.recordingIntoHost(second, 2);  // isn't submitted yet
    queue.add([&] { ++destroyed; });
    queue.collect(4, 0);
    CHECK(destroyed == 0);
    queue.collect(5, 0);
    CHECK(destroyed == 1);
    queue.hostSubmitted(7);
    queue.hostSubmitted(9);  // the first that follows it counts
    queue.collect(6, 1);
    CHECK(destroyed == 1);
    queue.collect(7, 1);
    CHECK(destroyed == 2);
}

TEST_CASE("objects dropped in mid-flight live until the GPU is done") {
    TestDevice t;
    Buffer kept = must(Buffer::create(t.device, "kept", 4096 * 4));
    uint64_t value = 0;
    {
        Program fill = must(Program::compute(t.device, "tests/fill.comp"));
        Buffer dropped = must(Buffer::create(t.device, "dropped", 4096 * 4));
        Commands commands = must(Commands::begin(t.device, "in flight"));
        {
            Pass pass(commands, "busy");
            pass.dispatchItems(fill, 4096, FillPush{dropped.address(), 4096, 3, 20000});
        }
        commands.barrier(Use::compute, Use::transfer);
        commands.copy(dropped, kept, 4096 * 4);
        value = must(commands.submit());
    }
    const bool running = t.device.completed() < value;
    if (running) CHECK(t.device.retiredCount() > 0);
    REQUIRE(t.device.wait(value));
    CHECK(t.device.retiredCount() == 0);
    uint32_t want = 5 * 3;
    for (int k = 0; k < 20000; ++k) want = want * 1664525u + 1013904223u;
    CHECK(must(readVector<uint32_t>(t.device, kept, 5, 1))[0] == want);
}

TEST_CASE("a recording that is never submitted costs nothing") {
    TestDevice t;
    for (int i = 0; i < 10; ++i) {
        Commands commands = must(Commands::begin(t.device, "discarded"));
        Pass pass(commands, "never");
        Buffer buffer = must(Buffer::create(t.device, "short", 64));
        commands.fill(buffer, 1);
    }
    t.device.collect();
    CHECK(t.device.retiredCount() == 0);
    CHECK(t.device.milliseconds("never") == 0);
}

TEST_CASE("uploads of any size and place arrive in order") {
    TestDevice t;
    Buffer buffer = must(Buffer::create(t.device, "target", 100001));
    Commands commands = must(Commands::begin(t.device, "uploads"));
    const std::vector<uint8_t> ones(100001, 1), twos(5, 2), threes(8, 3);
    REQUIRE(commands.upload(buffer, ones));
    commands.barrier(Use::transfer, Use::transfer);
    REQUIRE(commands.upload(buffer, twos, 7));
    REQUIRE(commands.upload(buffer, threes, 64));
    REQUIRE(commands.finish());
    const std::vector<uint8_t> got = must(readVector<uint8_t>(t.device, buffer, 0, 100001));
    CHECK((got[6] == 1 && got[7] == 2 && got[11] == 2 && got[12] == 1));
    CHECK((got[63] == 1 && got[64] == 3 && got[71] == 3 && got[72] == 1 && got[100000] == 1));
}

TEST_CASE("images come back as they went, through samplers and storage") {
    TestDevice t;
    const uint32_t width = 37, height = 21;  // no multiple of anything
    std::vector<uint8_t> texels(width * height * 4);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = uint8_t(i * 7);
    ImageDesc desc;
    desc.name = "source";
    desc.width = width;
    desc.height = height;
    desc.levels = 0;
    Image source = must(Image::create(t.device, desc));
    CHECK(source.levels() == 6);
    REQUIRE(fillImage(t.device, source, std::as_bytes(std::span(texels))));
    desc.name = "target";
    desc.levels = 1;
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    Image target = must(Image::create(t.device, desc));
    Sampler sampler = must(Sampler::create(t.device, {.name = "linear", .anisotropy = 8}));
    Program swap = must(Program::compute(t.device, "tests/bindings.comp"));
    Buffer count = must(makeBuffer(t.device, "count", std::vector<uint32_t>{0}));

    Commands commands = must(Commands::begin(t.device, "swap"));
    commands.transition(target, ImageState::storage);
    Pass(commands, "swap").dispatch(swap, {5, 6, 1}, {}, {{source, sampler}, target, count});
    REQUIRE(commands.finish());
    const std::vector<std::byte> got = must(readImage(t.device, target));
    REQUIRE(got.size() == texels.size());
    bool right = true;
    for (size_t i = 0; i < got.size(); i += 4) {
        right = right && uint8_t(got[i]) == texels[i + 2] && uint8_t(got[i + 1]) == texels[i + 1];
        right = right && uint8_t(got[i + 2]) == texels[i] && uint8_t(got[i + 3]) == texels[i + 3];
    }
    CHECK(right);
    CHECK(must(readVector<uint32_t>(t.device, count, 0, 1))[0] == width * height);
}

TEST_CASE("draws, indirect and counted, fill what they should") {
    TestDevice t;
    ImageDesc desc;
    desc.name = "canvas";
    desc.width = 64;
    desc.height = 32;
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    Image canvas = must(Image::create(t.device, desc));
    desc.name = "depth";
    desc.format = VK_FORMAT_D32_SFLOAT;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    Image depth = must(Image::create(t.device, desc));
    GraphicsDesc look;
    look.name = "triangle";
    look.vertex = "tests/triangle.vert";
    look.fragment = "tests/triangle.frag";
    look.colors = {canvas.format()};
    look.depth = depth.format();
    look.blend = Blend::additive;
    Program triangle = must(Program::graphics(t.device, look));
    CHECK(triangle.pushBytes() == 16);
    Buffer arguments =
        must(makeBuffer(t.device, "arguments", std::vector<uint32_t>{3, 1, 0, 0, 3, 1, 0, 0, 3, 5, 0, 0}));

    Buffer indices = must(makeBuffer(t.device, "indices", std::vector<uint32_t>{0, 1, 2}));
    Buffer indexed = must(makeBuffer(t.device, "indexed", std::vector<uint32_t>{3, 1, 0, 0, 0}));

    Commands commands = must(Commands::begin(t.device, "draw"));
    commands.transition(canvas, ImageState::colorTarget);
    commands.transition(depth, ImageState::depthTarget);
    {
        const DrawTargets targets{
            canvas.extent(), {{.view = canvas.view(), .clear = {{0, 0, 0, 1}}}}, DepthTarget{depth.view(), 1.0f}};
        DrawPass pass(commands, "draw", targets);
        const std::array<float, 4> red{0.2f, 0, 0, 0}, green{0, 0.2f, 0, 0}, blue{0, 0, 0.2f, 0};
        pass.draw(triangle, 3, 1, red);
        pass.drawIndirect(triangle, arguments, 0, 2, green);
        pass.drawIndirect(triangle, arguments, 32, 1, blue);  // one command of five instances
        pass.setIndices(indices);
        pass.drawIndexed(triangle, {.indices = 3}, red);
        pass.drawIndexedIndirect(triangle, indexed, 0, 1, red);
        pass.drawIndexedIndirect(triangle, indexed, 0, 1, red);
    }
    REQUIRE(commands.finish());
    const std::vector<std::byte> got = must(readImage(t.device, canvas));
    auto channel = [&](uint32_t x, uint32_t y, uint32_t c) { return int(got[(y * 64 + x) * 4 + c]); };
    CHECK(channel(4, 16, 0) == 4 * 51);
    CHECK(channel(4, 16, 1) == 102);
    CHECK(channel(4, 16, 2) == 255);
    CHECK(channel(60, 16, 0) + channel(60, 16, 1) + channel(60, 16, 2) == 0);
    CHECK(t.device.milliseconds("draw") > 0);
}
