// Making devices: ours, a host's, none at all; and the validation layer's messages.
#include <dlfcn.h>

#include <cstdlib>

#include "runtime/gpu/features.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/support/driver_between.hpp"

using namespace espalier;
using test::hostOf;

namespace {

// Sets an environment variable for a scope.
class Environment {
  public:
    Environment(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old, had_ = true;
        ::setenv(name, value, 1);
    }
    ~Environment() {
        if (had_)
            ::setenv(name_, old_.c_str(), 1);
        else
            ::unsetenv(name_);
    }

  private:
    const char* name_;
    std::string old_;
    bool had_ = false;
};

class CountingMemory : public MemorySource {
  public:
    explicit CountingMemory(MemorySource& source) : source_(source) {}
    Result<MemoryBlock> allocate(const MemoryRequest& request) override {
        ++live;
        return source_.allocate(request);
    }
    void free(const MemoryBlock& block) noexcept override {
        --live;
        source_.free(block);
    }
    uint64_t bytesUsed() const override { return source_.bytesUsed(); }
    uint64_t bytesReserved() const override { return source_.bytesReserved(); }
    int live = 0;

  private:
    MemorySource& source_;
};

}  // namespace

TEST_CASE("without a driver the message says so and names the environment") {
    Environment files("VK_DRIVER_FILES", "/nowhere/driver.json");
    Environment names("VK_ICD_FILENAMES", "/nowhere/driver.json");
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE_FALSE(device);
    CHECK(device.failure().text().find("no Vulkan driver") != std::string::npos);
    CHECK(device.failure().text().find("/nowhere/driver.json") != std::string::npos);
}

TEST_CASE("a device that isn't there is named") {
    DeviceOptions options;
    options.deviceName = "Voodoo2";
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE_FALSE(device);
    CHECK(device.failure().text().find("not the one asked for") != std::string::npos);
}

TEST_CASE("a device describes itself") {
    TestDevice t;
    MESSAGE(t.device.info().name << ", " << t.device.info().driver);
    CHECK_FALSE(t.device.info().name.empty());
    CHECK(t.device.info().subgroupSize >= 1);
    CHECK(t.device.info().limits.maxPushConstantsSize >= 128);
}

TEST_CASE("an incomplete host is refused") {
    TestDevice t;
    HostDevice host = hostOf(t.device);
    host.queue = VK_NULL_HANDLE;
    REQUIRE_FALSE(Device::adopt(host));
    host = hostOf(t.device);
    host.queueFamily = 77;
    Result<std::unique_ptr<Device>> adopted = Device::adopt(host);
    REQUIRE_FALSE(adopted);
    CHECK(adopted.failure().text().find("queue family 77") != std::string::npos);
}

// What a host says that it made its device with, and what becomes of that.
struct Made {
    Features features;
    const char* extension = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};

    Made() {
        chooseFeatures(Features(), features);
        info.pNext = &features.core;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    std::string adopt(HostDevice host) const {
        host.made = &info;
        Result<std::unique_ptr<Device>> adopted = Device::adopt(host);
        return adopted ? "" : adopted.failure().text();
    }
};

TEST_CASE("textures of a host's device are filtered by angle where the host says that it may be") {
    TestDevice t;
    HostDevice host = hostOf(t.device);
    CHECK(must(Device::adopt(host))->info().maxAnisotropy == 1);
    Made made;
    host.made = &made.info;
    CHECK(must(Device::adopt(host))->info().maxAnisotropy == 1);
    made.features.core.features.samplerAnisotropy = VK_TRUE;
    CHECK(must(Device::adopt(host))->info().maxAnisotropy == t.device.info().maxAnisotropy);
}

TEST_CASE("a host's device that was made without what is required is refused, and what it lacks is named") {
    TestDevice t;
    const HostDevice host = hostOf(t.device);
    Made made;
    CHECK(made.adopt(host) == "");
    made.features.v12.timelineSemaphore = VK_FALSE;
    made.features.core.features.shaderInt64 = VK_FALSE;
    CHECK(made.adopt(host).find("shaderInt64, timelineSemaphore") != std::string::npos);
    // Structs of one feature each say the same.
    VkPhysicalDeviceTimelineSemaphoreFeatures single{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES};
    single.timelineSemaphore = VK_TRUE;
    made.features.v13.pNext = &single;
    made.features.core.features.shaderInt64 = VK_TRUE;
    CHECK(made.adopt(host) == "");
    // Core features, in the other place for them.
    made.features.core.features = {};
    CHECK(made.adopt(host).find("multiDrawIndirect") != std::string::npos);
    Features required;
    chooseFeatures(Features(), required);
    made.info.pEnabledFeatures = &required.core.features;
    made.info.pNext = &made.features.v11;
    CHECK(made.adopt(host) == "");
    made.info.enabledExtensionCount = 0;
    CHECK(made.adopt(host).find(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) != std::string::npos);
}

TEST_CASE("a host's device works, with the host's memory, commands and frames") {
    TestDevice t;
    HostDevice host = hostOf(t.device);
    CountingMemory memory(t.device.memory());
    host.memory = &memory;
    {
        std::unique_ptr<Device> adopted = must(Device::adopt(host));
        Program fill = must(Program::compute(*adopted, "tests/fill.comp"));
        Buffer words = must(Buffer::create(*adopted, "words", 100 * 4));
        CHECK(memory.live == 1);

        Commands frame = must(Commands::begin(t.device, "host frame"));  // plays the host's command buffer
        {
            Commands inside = Commands::into(*adopted, frame.handle(), 1);
            Pass pass(inside, "hosted");
            pass.dispatchItems(fill, 100, FillPush{words.address(), 100, 3});
            Buffer dropped = std::move(words);  // in use by frame 1
        }
        CHECK(adopted->retiredCount() > 0);
        REQUIRE(frame.finish());
        adopted->collect();
        CHECK(memory.live == 1);  // the host hasn't said that frame 1 is done
        adopted->hostFrameDone(1);
        CHECK(memory.live == 0);
        CHECK(adopted->milliseconds("hosted") > 0);
    }
    CHECK(memory.live == 0);
}

TEST_CASE("the layer's messages are counted and kept") {
    DeviceOptions options = validated();
    int logged = 0;
    options.log = [&](Severity, std::string_view) { ++logged; };
    std::unique_ptr<Device> device = must(Device::create(options));
    CHECK(device->validationMessages() == 0);
    Buffer buffer = must(Buffer::create(*device, "wrong", 64));
    Commands commands = must(Commands::begin(*device, "wrong"));
    device->vk().vkCmdFillBuffer(commands.handle(), buffer.handle(), 1, 4, 0);  // an odd offset
    CHECK(device->validationMessages() > 0);
    CHECK(logged > 0);
    REQUIRE_FALSE(device->validationTexts().empty());
    CHECK(device->validationTexts()[0].find("vkCmdFillBuffer") != std::string::npos);
}

TEST_CASE("two devices live side by side, one without validation") {
    TestDevice a;
    std::unique_ptr<Device> b = must(Device::create());
    Buffer inA = must(makeBuffer(a.device, "a", std::vector<uint32_t>{1, 2, 3}));
    Buffer inB = must(makeBuffer(*b, "b", std::vector<uint32_t>{4, 5, 6}));
    CHECK(must(readVector<uint32_t>(a.device, inA, 0, 3)) == std::vector<uint32_t>{1, 2, 3});
    CHECK(must(readVector<uint32_t>(*b, inB, 0, 3)) == std::vector<uint32_t>{4, 5, 6});
}

TEST_CASE("missing barriers are noticed") {
    DeviceOptions options = validated();
    options.log = [](Severity, std::string_view) {};
    std::unique_ptr<Device> device = must(Device::create(options));
    Buffer buffer = must(Buffer::create(*device, "written twice", 64));
    Commands commands = must(Commands::begin(*device, "wrong"));
    commands.fill(buffer, 1);
    commands.barrier(Use::transfer, Use::transfer);
    commands.fill(buffer, 2);
    CHECK(device->validationMessages() == 0);
    commands.fill(buffer, 3);
    CHECK(device->validationMessages() == 1);
}
