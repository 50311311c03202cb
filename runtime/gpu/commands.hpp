#pragma once

#include <array>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "runtime/gpu/buffer.hpp"
#include "runtime/gpu/image.hpp"
#include "runtime/gpu/program.hpp"

namespace espalier {

// How memory is touched, for barriers; combine with |.
enum class Use : uint32_t {
    host = 1,       // reads by the CPU after the work has finished
    transfer = 2,   // fill, copy, upload
    compute = 4,    // reads and writes of compute shaders
    indirect = 8,   // arguments of indirect dispatches and draws, and their counts
    vertex = 16,    // reads of vertex shaders, index and vertex fetch
    fragment = 32,  // reads of fragment shaders
    all = 64        // everything, for what is out of our sight
};
constexpr Use operator|(Use a, Use b) {
    return Use(uint32_t(a) | uint32_t(b));
}

// A recording: either a command buffer of ours, which submit() sends off, or one that a host has begun. One of ours
// waits for all that was submitted before it, a host's too, and sees what that did; the CPU sees what it did once it is
// done. Within a recording, and between a host's, ask for barriers.
// Dropping an unsubmitted recording of ours discards it.
class Commands {
  public:
    // Fails when memory has run out.
    static Result<Commands> begin(Device& device, std::string_view name);
    // Records into the host's command buffer (in the recording state, of the device's queue family, outside of
    // rendering unless a DrawPass says so). Objects dropped from now on live until hostFrameDone(frame).
    // within: rendering that the host has begun; nothing of it is timed.
    static Commands into(Device& device, VkCommandBuffer hostCommands, uint64_t frame, bool within = false);

    Commands(Commands&& other) noexcept;
    Commands& operator=(Commands&&) = delete;
    ~Commands();

    // The timeline's value when the work is done. Only for recordings of ours, once.
    Result<uint64_t> submit();
    // submit and wait until it is done.
    Status finish();

    // What `before` has written, or read, is seen by, or free to be written by, `after`.
    void barrier(Use before, Use after);
    // Waits for earlier uses of the image. From `undefined`, or with discard, its contents are lost.
    void transition(Image& image, ImageState state, bool discard = false);

    // Offsets and sizes in bytes, multiples of 4; size ~0: to the end.
    void fill(const Buffer& buffer, uint32_t word, uint64_t offset = 0, uint64_t size = ~0ull);
    void copy(const Buffer& from, const Buffer& to, uint64_t size, uint64_t fromOffset = 0, uint64_t toOffset = 0);
    // Copies the bytes now; the GPU writes them as a Use::transfer at this point of the recording. Fails when memory
    // has run out.
    Status upload(const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);
    template <class T>
    Status upload(const Buffer& buffer, const std::vector<T>& values, uint64_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        return upload(buffer, std::as_bytes(std::span(values)), offset);
    }
    // Tightly packed texels; the image must be in copyTarget (copySource).
    void copyToImage(const Buffer& from, uint64_t offset, Image& image, uint32_t level = 0, uint32_t layer = 0);
    void copyFromImage(Image& image, const Buffer& to, uint64_t offset = 0, uint32_t level = 0, uint32_t layer = 0);
    // Fills levels 1.. from level 0 and leaves the image `sampled`.
    void makeMips(Image& image);

    Device& device() const { return *device_; }
    VkCommandBuffer handle() const { return handle_; }
    uint64_t serial() const { return serial_; }
    bool hosted() const { return !ours_; }
    bool within() const { return within_; }

  private:
    Commands() = default;
    Device* device_ = nullptr;
    VkCommandBuffer handle_ = VK_NULL_HANDLE;
    uint64_t serial_ = 0;  // its number among the device's recordings
    bool ours_ = false, within_ = false;
};

// The push data of a dispatch or draw: a trivially copyable struct, checked against the program's size.
struct Push {
    Push() = default;
    Push(const void* bytes, uint32_t count) : data(bytes), size(count) {}
    template <class T>
    requires(std::is_trivially_copyable_v<T> && !std::is_same_v<T, Push>) Push(const T& value)
        : data(&value), size(sizeof(T)) {}
    const void* data = nullptr;
    uint32_t size = 0;
};
// What a program's bindings get, in the order of their numbers: a view of a list that lives as long as the call.
class Bindings {
  public:
    Bindings() = default;
    Bindings(std::initializer_list<Binding> list) : first_(std::data(list)), size_(list.size()) {}
    Bindings(const std::vector<Binding>& list) : first_(list.data()), size_(list.size()) {}
    const Binding& operator[](size_t i) const { return first_[i]; }
    size_t size() const { return size_; }

  private:
    const Binding* first_ = nullptr;
    size_t size_ = 0;
};

// A labelled and timed stretch of a recording. The pass lasts as long as the object. Passes of one name in one
// recording are summed. Between dispatches of a pass there is no barrier but those you ask for.
class Pass {
  public:
    Pass(Commands& commands, std::string_view name) : Pass(commands, name, true) {}
    ~Pass();
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

    void dispatch(const Program& program, std::array<uint32_t, 3> groups, Push push = {}, Bindings bindings = {});
    // One invocation an item and some more, by the program's local size (x only); 0 items are fine. Beyond 65,535
    // groups they spread over y: a kernel finds its item with itemIndex() of shaders/shared/dispatch.glsl.
    void dispatchItems(const Program& program, uint32_t items, Push push = {}, Bindings bindings = {});
    // arguments: a VkDispatchIndirectCommand at `offset`.
    void dispatchIndirect(const Program& program, const Buffer& arguments, uint64_t offset, Push push = {},
                          Bindings bindings = {});
    void barrier(Use before, Use after) { commands_.barrier(before, after); }
    Commands& commands() { return commands_; }

  protected:
    Pass(Commands& commands, std::string_view name, bool timed);
    void bind(const Program& program, const Push& push, Bindings bindings);
    Commands& commands_;
    const DeviceFunctions& vk_;
    VkCommandBuffer cmd_;
    std::optional<uint32_t> timer_;
};

struct ColorTarget {
    VkImageView view = VK_NULL_HANDLE;
    std::optional<std::array<float, 4>> clear;  // none: what is there stays
};
struct DepthTarget {
    VkImageView view = VK_NULL_HANDLE;
    std::optional<float> clear;
    bool store = true;  // false: nobody reads it later
};
// The images must be in colorTarget and depthTarget.
struct DrawTargets {
    VkExtent2D extent{};
    std::vector<ColorTarget> colors;
    std::optional<DepthTarget> depth;
};

// A pass that draws. Viewport and scissor are the whole extent; clip space is Vulkan's: y down, depth 0 to 1.
class DrawPass : public Pass {
  public:
    DrawPass(Commands& commands, std::string_view name, const DrawTargets& targets);
    // In rendering that somebody else has begun and will end. It isn't timed.
    DrawPass(Commands& commands, std::string_view name, const VkViewport& viewport);
    ~DrawPass();

    void setScissor(int32_t x, int32_t y, uint32_t width, uint32_t height);
    void setViewport(const VkViewport& viewport);
    // Whether triangles' backs are drawn too; at first they are.
    void drawBacks(bool drawn);
    // The view is seen in a mirror, or isn't: at first it isn't.
    void mirror(bool mirrored);
    // What is drawn next is placed mirrored, or isn't: likewise.
    void mirrorPlaced(bool mirrored);
    // For programs with GraphicsDesc::inputs.
    void setVertices(const Buffer& vertices, uint64_t offset = 0);
    void setIndices(const Buffer& indices, VkIndexType type = VK_INDEX_TYPE_UINT32, uint64_t offset = 0);

    void draw(const Program& program, uint32_t vertices, uint32_t instances, Push push = {}, Bindings bindings = {});
    struct IndexRange {
        uint32_t indices;
        uint32_t firstIndex = 0;
        int32_t vertexOffset = 0;
        uint32_t instances = 1;
    };
    void drawIndexed(const Program& program, const IndexRange& range, Push push = {}, Bindings bindings = {});
    // `count` commands, tightly packed (VkDrawIndirectCommand, VkDrawIndexedIndirectCommand).
    void drawIndirect(const Program& program, const Buffer& arguments, uint64_t offset, uint32_t count, Push push = {},
                      Bindings bindings = {});
    void drawIndexedIndirect(const Program& program, const Buffer& arguments, uint64_t offset, uint32_t count,
                             Push push = {}, Bindings bindings = {});

  private:
    bool begun_ = false;     // by us
    bool mirrored_ = false;  // the view
};

}  // namespace espalier
