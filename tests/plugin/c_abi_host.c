/* Contexts on a device of their own, and on one that a host has made. */
#include <string.h>
#include <vulkan/vulkan.h>

#include "tests/plugin/c_abi.h"

static void countLog(void* user, EspLogLevel level, const char* message) {
    (void)message;
    if (level == ESP_LOG_ERROR) ++*(int*)user;
}

/* As espCreate is told of it: static, since EspHostDevice leads to it. */
static VkDeviceCreateInfo made;

EspHostDevice makeHost(uint32_t apiVersion) {
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = apiVersion};
    VkInstanceCreateInfo instanceInfo = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                         .pApplicationInfo = &application};
    VkInstance instance;
    CHECK(vkCreateInstance(&instanceInfo, NULL, &instance) == VK_SUCCESS);
    uint32_t count = 1;
    VkPhysicalDevice physical;
    CHECK(vkEnumeratePhysicalDevices(instance, &count, &physical) >= 0 && count == 1);
    uint32_t extensionCount = 0;
    const char* const* extensions = espRequiredExtensions(&extensionCount);
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo deviceInfo = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = espRequiredFeatures(),
                                     .enabledExtensionCount = extensionCount,
                                     .ppEnabledExtensionNames = extensions};
    made = deviceInfo;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    VkDevice device;
    CHECK(vkCreateDevice(physical, &deviceInfo, NULL, &device) == VK_SUCCESS);
    VkQueue queue;
    vkGetDeviceQueue(device, 0, 0, &queue);
    EspHostDevice host = {.structSize = sizeof host,
                          .getInstanceProcAddr = (void*)vkGetInstanceProcAddr,
                          .instance = instance,
                          .physicalDevice = physical,
                          .device = device,
                          .queue = queue,
                          .deviceInfo = &made};
    return host;
}

EspContext* create(const EspHostDevice* host, const char* cache) {
    EspContextDef def = {.structSize = sizeof def};
    espDefaultContextDef(&def);
    EspContext* context = NULL;
    const char* validation = getenv("ESPALIER_VALIDATION");
    def.host = host;
    def.validation = validation && !strcmp(validation, "1");
    def.log = countLog;
    def.logUser = &logged;
    def.cacheFolder = cache;
    OK(NULL, espCreate(ESP_VERSION, &def, &context));
    CHECK(context != NULL && espDeviceName(context)[0] != 0 && espDriverName(context)[0] != 0 &&
          espLastError(context)[0] == 0);
    return context;
}
