// In: a host's device, or none. Out: a device that was checked, and what draws and grows on it.
#include "runtime/plugin/device_parts.hpp"

#include "runtime/gpu/commands.hpp"
#include "runtime/plugin/checked_devices.hpp"
#include "runtime/plugin/errors.hpp"

namespace espalier {
namespace {

Result<std::unique_ptr<Device>> makeDevice(const EspContext& context, const EspHostDevice* given) {
    if (!given) {
        DeviceOptions options;
        options.validation = context.validation;
        options.log = context.log;
        return Device::create(options);
    }
    HostDevice host;
    host.getInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(given->getInstanceProcAddr);
    host.instance = static_cast<VkInstance>(given->instance);
    host.physicalDevice = static_cast<VkPhysicalDevice>(given->physicalDevice);
    host.device = static_cast<VkDevice>(given->device);
    host.queue = static_cast<VkQueue>(given->queue);
    host.queueFamily = given->queueFamily;
    host.debugUtils = given->debugUtils != 0;
    host.made = static_cast<const VkDeviceCreateInfo*>(given->deviceInfo);
    host.pipelineCache = reinterpret_cast<VkPipelineCache>(given->pipelineCache);
    host.log = context.log;
    return Device::adopt(host);
}

}  // namespace

const char* mistakeIn(const EspHostDevice& host) {
    if (!host.getInstanceProcAddr || !host.instance || !host.physicalDevice || !host.device || !host.queue)
        return "a handle of the host's device is null";
    if (!host.deviceInfo)
        return "EspHostDevice::deviceInfo is null: it is the VkDeviceCreateInfo that the device was made with";
    return nullptr;
}

EspResult makeDeviceParts(const EspContext& context, const EspHostDevice* host, DeviceParts& out, std::string& why) {
    const auto failed = [&](EspResult code, const Failure& failure) {
        why = failure.text();
        return code;
    };
    if (Status made = assign(out.device, makeDevice(context, host)); !made)
        return failed(ESP_NO_DEVICE, made.failure());
    Device& device = *out.device;
    if (context.checksDevice)
        if (Status checked = checkDevice(device, context.cacheFolder); !checked)
            return failed(gpuCode(device, checked.failure()), checked.failure());
    const std::string path = context.terminals.string();
    Result<std::vector<std::byte>> file = context.files.read(path);
    if (!file) {
        why = "terminal meshes: " + file.failure().text();
        return ESP_IO_FAILED;
    }
    Result<TerminalData> meshes = parseTerminals(*file, path);
    if (!meshes) return failed(ESP_INVALID_CONTENT, meshes.failure());
    if (Status made = assign(out.renderer, Renderer::create(device, std::move(*meshes))); !made)
        return failed(gpuCode(device, made.failure()), made.failure());
    // Room for a well-grown scene, so that only large ones have to grow twice.
    const GrowthRoom room{.chunks = 32768, .nodes = 262144, .branches = 32768, .leaves = 262144, .items = 32768};
    if (Status made = assign(out.growth, Growth::create(device, room)); !made)
        return failed(gpuCode(device, made.failure()), made.failure());
    return ESP_OK;
}

Status finishFrames(Device& device, const char* name) {
    device.hostSubmitted();
    Result<Commands> commands = Commands::begin(device, name);
    if (!commands) return commands.failure();
    return commands->finish();
}

}  // namespace espalier
