// What a device asks of its driver, and what it makes of the answers.
#include <vector>

#include "tests/gpu/gpu_test.hpp"
#include "tests/support/driver_between.hpp"

using namespace espalier;

namespace {

// Of the driver that a test puts in between.
PFN_vkCmdPipelineBarrier2 realBarrier;
std::vector<VkMemoryBarrier2> barriers;
VKAPI_ATTR void VKAPI_CALL noteBarrier(VkCommandBuffer commands, const VkDependencyInfo* info) {
    barriers.insert(barriers.end(), info->pMemoryBarriers, info->pMemoryBarriers + info->memoryBarrierCount);
    realBarrier(commands, info);
}

PFN_vkGetSemaphoreCounterValue realCounter;
bool knowsCounter = true;
VKAPI_ATTR VkResult VKAPI_CALL counter(VkDevice device, VkSemaphore semaphore, uint64_t* value) {
    return knowsCounter ? realCounter(device, semaphore, value) : VK_ERROR_OUT_OF_HOST_MEMORY;
}

// As drivers whose compiler has failed.
VKAPI_ATTR VkResult VKAPI_CALL noPipeline(VkDevice, VkPipelineCache, uint32_t count, const VkComputePipelineCreateInfo*,
                                          const VkAllocationCallbacks*, VkPipeline* made) {
    for (uint32_t i = 0; i < count; ++i) made[i] = VK_NULL_HANDLE;
    return VK_ERROR_UNKNOWN;
}

PFN_vkGetPhysicalDeviceProperties2 realProperties;
VKAPI_ATTR void VKAPI_CALL withoutBallots(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all) {
    realProperties(device, all);
    for (auto* next = static_cast<VkBaseOutStructure*>(all->pNext); next; next = next->pNext)
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES)
            reinterpret_cast<VkPhysicalDeviceVulkan11Properties*>(next)->subgroupSupportedOperations =
                VK_SUBGROUP_FEATURE_BASIC_BIT;
}

VKAPI_ATTR void VKAPI_CALL smallUniforms(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all) {
    realProperties(device, all);
    all->properties.limits.maxUniformBufferRange = 16384;  // Vulkan's least
}

// As lavapipe has where its vectors have 128 bits.
VKAPI_ATTR void VKAPI_CALL fewLanes(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all) {
    realProperties(device, all);
    for (auto* next = static_cast<VkBaseOutStructure*>(all->pNext); next; next = next->pNext)
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES)
            reinterpret_cast<VkPhysicalDeviceVulkan11Properties*>(next)->subgroupSize = 4;
}

// Why a device whose properties are told by `properties` isn't taken.
std::string refusal(Device& real, PFN_vkGetPhysicalDeviceProperties2 properties) {
    realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
        real.getInstanceProcAddr()(real.instance(), "vkGetPhysicalDeviceProperties2"));
    test::DriverBetween driver(real);
    driver.replace("vkGetPhysicalDeviceProperties2", properties);
    const Result<std::unique_ptr<Device>> adopted = Device::adopt(driver.host());
    REQUIRE_FALSE(adopted);
    return adopted.failure().text();
}

// A device whose barriers are noted.
std::unique_ptr<Device> notingBarriers(Device& real) {
    realBarrier = real.vk().vkCmdPipelineBarrier2;
    test::DriverBetween driver(real);
    driver.replace("vkCmdPipelineBarrier2", noteBarrier);
    return must(Device::adopt(driver.host()));
}

// What was recorded at the beginning of a recording of ours.
std::vector<VkMemoryBarrier2> barriersOfBeginning(Device& device) {
    barriers.clear();
    const Commands ours = must(Commands::begin(device, "ours"));
    return barriers;
}

}  // namespace

TEST_CASE("what we submit waits for a host's frames") {
    TestDevice t;
    std::unique_ptr<Device> adopted = notingBarriers(t.device);
    CHECK(barriersOfBeginning(*adopted).empty());  // ours end with one
    Commands frame = must(Commands::begin(t.device, "host frame"));
    (void)Commands::into(*adopted, frame.handle(), 1);
    REQUIRE(frame.finish());
    for (int again = 0; again < 2; ++again) {
        const auto first = barriersOfBeginning(*adopted);
        REQUIRE(first.size() == 1);
        CHECK(first[0].srcStageMask == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        CHECK(first[0].dstStageMask == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        CHECK(first[0].srcAccessMask == VK_ACCESS_2_MEMORY_WRITE_BIT);
        CHECK((first[0].dstAccessMask & VK_ACCESS_2_MEMORY_WRITE_BIT) != 0);
    }
    adopted->hostFrameDone(1);
}

TEST_CASE("barriers know of uniform blocks and of vertices") {
    TestDevice t;
    std::unique_ptr<Device> adopted = notingBarriers(t.device);
    Commands commands = must(Commands::begin(*adopted, "barriers"));
    for (Use use : {Use::vertex, Use::fragment, Use::compute}) {
        barriers.clear();
        commands.barrier(Use::transfer, use);
        REQUIRE(barriers.size() == 1);
        CHECK((barriers[0].dstAccessMask & VK_ACCESS_2_UNIFORM_READ_BIT) != 0);
        const bool vertices = (barriers[0].dstAccessMask & VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT) != 0;
        CHECK(vertices == (use == Use::vertex));
    }
}

TEST_CASE("nothing is destroyed while nobody knows what the GPU has finished") {
    TestDevice t;
    realCounter = t.device.vk().vkGetSemaphoreCounterValue;
    test::DriverBetween driver(t.device);
    driver.replace("vkGetSemaphoreCounterValue", counter);
    std::unique_ptr<Device> adopted = must(Device::adopt(driver.host()));
    knowsCounter = false;
    {
        Buffer used = must(Buffer::create(*adopted, "used", 64));
        Commands commands = must(Commands::begin(*adopted, "uses it"));
        commands.fill(used, 1);
        REQUIRE(commands.submit());
    }
    adopted->collect();
    CHECK(adopted->retiredCount() > 0);
    CHECK_FALSE(adopted->lost());
    knowsCounter = true;
    REQUIRE(adopted->waitIdle());
    CHECK(adopted->retiredCount() == 0);
}

TEST_CASE("what a driver fails at without a reason is a failure that says so, and no end of the program") {
    TestDevice t;
    test::DriverBetween driver(t.device);
    driver.replace("vkCreateComputePipelines", noPipeline);
    std::unique_ptr<Device> adopted = must(Device::adopt(driver.host()));
    const Result<Program> program = Program::compute(*adopted, "tests/fill.comp");
    REQUIRE_FALSE(program);
    CHECK(program.failure().text().find("the GPU's driver failed") != std::string::npos);
    CHECK_FALSE(adopted->lost());
}

TEST_CASE("a device whose subgroups can't vote, or whose uniform blocks are small, is refused by name") {
    TestDevice t;
    CHECK(refusal(t.device, withoutBallots).find("ballots") != std::string::npos);
    CHECK(refusal(t.device, smallUniforms).find("uniform blocks of 65536 bytes") != std::string::npos);
}

TEST_CASE("a driver that is known to miscompile our kernels is refused by its name, with what has brought it about") {
    TestDevice t;
    ::setenv("LP_NATIVE_VECTOR_WIDTH", "128", 1);
    const std::string text = refusal(t.device, fewLanes);
    ::unsetenv("LP_NATIVE_VECTOR_WIDTH");
    CAPTURE(text);
    for (const char* part : {"llvmpipe", "miscompile", "LP_NATIVE_VECTOR_WIDTH is set to \"128\""})
        CHECK(text.find(part) != std::string::npos);
}

TEST_CASE("more texels than the GPU reads of a buffer are refused") {
    TestDevice t;
    const uint64_t most = t.device.info().limits.maxTexelBufferElements;
    if (most + 64 > t.device.info().maxBufferBytes || most > 1u << 28) return;
    const Buffer full = must(Buffer::create(t.device, "full", most)),
                 large = must(Buffer::create(t.device, "large", most + 64));
    CHECK(TexelView::create(t.device, full, VK_FORMAT_R8_UNORM));
    const Result<TexelView> refused = TexelView::create(t.device, large, VK_FORMAT_R8_UNORM);
    REQUIRE_FALSE(refused);
    CHECK(refused.failure().text().find("large") != std::string::npos);
}
