/* A host whose VkPipelineCache is used, and for whom no frame makes a pipeline that espWarmUp could have made. */
#include <string.h>
#include <vulkan/vulkan.h>

#include "tests/plugin/check.h"

enum { kSide = 64 };

static int made = 0, cached = 0;
static VkPipelineCache cache;
static PFN_vkCreateGraphicsPipelines realGraphics;
static PFN_vkCreateComputePipelines realCompute;
static PFN_vkGetDeviceProcAddr realDeviceProc;

static VKAPI_ATTR VkResult VKAPI_CALL graphics(VkDevice device, VkPipelineCache given, uint32_t count,
                                               const VkGraphicsPipelineCreateInfo* infos,
                                               const VkAllocationCallbacks* memory, VkPipeline* out) {
    made += (int)count;
    cached += given == cache;
    return realGraphics(device, given, count, infos, memory, out);
}
static VKAPI_ATTR VkResult VKAPI_CALL compute(VkDevice device, VkPipelineCache given, uint32_t count,
                                              const VkComputePipelineCreateInfo* infos,
                                              const VkAllocationCallbacks* memory, VkPipeline* out) {
    made += (int)count;
    cached += given == cache;
    return realCompute(device, given, count, infos, memory, out);
}
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = realDeviceProc(device, name);
    if (!strcmp(name, "vkCreateGraphicsPipelines")) {
        realGraphics = (PFN_vkCreateGraphicsPipelines)real;
        return (PFN_vkVoidFunction)graphics;
    }
    if (!strcmp(name, "vkCreateComputePipelines")) {
        realCompute = (PFN_vkCreateComputePipelines)real;
        return (PFN_vkVoidFunction)compute;
    }
    return real;
}
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = vkGetInstanceProcAddr(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0) return real;
    realDeviceProc = (PFN_vkGetDeviceProcAddr)real;
    return (PFN_vkVoidFunction)deviceProc;
}

static const char* kIvy =
    "Ivy -> Stem\n"
    "Stem : arc >= 0.6 -> NULL\n"
    "Stem -> Marching(0.05, rand(-0.3, 0.3), true) {Stem, Wood}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n";

static void grow(EspContext* context, const char* file) {
    EspSurface surface = {0};
    OK(context, espLoadSurface(context, file, NULL, &surface));
    EspGrammarDef text = {sizeof text, "ivy", kIvy, strlen(kIvy)};
    EspSeedDef seed = {.structSize = sizeof seed};
    OK(NULL, espDefaultSeedDef(&seed));
    OK(context, espCompileGrammar(context, &text, &seed.grammar));
    seed.position[0] = seed.position[1] = 0.2f;
    seed.direction[1] = 1;
    EspSeed planted = {0};
    OK(context, espPlant(context, &seed, &planted));
    OK(context, espUpdate(context));
}

int main(int argc, char** argv) {
    CHECK(argc == 2);
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo instanceInfo = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                         .pApplicationInfo = &application};
    VkInstance instance;
    CHECK(vkCreateInstance(&instanceInfo, NULL, &instance) == VK_SUCCESS);
    uint32_t count = 1;
    VkPhysicalDevice physical;
    CHECK(vkEnumeratePhysicalDevices(instance, &count, &physical) >= 0 && count == 1);
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo deviceInfo = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = espRequiredFeatures(),
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queueInfo};
    deviceInfo.ppEnabledExtensionNames = espRequiredExtensions(&deviceInfo.enabledExtensionCount);
    VkDevice device;
    CHECK(vkCreateDevice(physical, &deviceInfo, NULL, &device) == VK_SUCCESS);
    VkPipelineCacheCreateInfo cacheInfo = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    CHECK(vkCreatePipelineCache(device, &cacheInfo, NULL, &cache) == VK_SUCCESS);
    EspHostDevice host = {.structSize = sizeof host,
                          .getInstanceProcAddr = (void*)instanceProc,
                          .instance = instance,
                          .physicalDevice = physical,
                          .device = device,
                          .deviceInfo = &deviceInfo,
                          .pipelineCache = (void*)cache};
    VkQueue queue;
    vkGetDeviceQueue(device, 0, 0, &queue);
    host.queue = queue;
    EspContextDef def = {.structSize = sizeof def};
    OK(NULL, espDefaultContextDef(&def));
    def.host = &host;
    def.skipSelfCheck = 1;
    EspContext* context = NULL;
    OK(NULL, espCreate(ESP_VERSION, &def, &context));
    grow(context, argv[1]);
    const int before = made;

    EspDrawDef draw = {.structSize = sizeof draw};
    EspLook look = {.structSize = sizeof look};
    EspHostScene scene = {.structSize = sizeof scene, .depthFormat = VK_FORMAT_D32_SFLOAT, .depthPerNearness = 0.1f};
    OK(NULL, espDefaultDrawDef(&draw));
    OK(NULL, espDefaultLook(&look));
    draw.width = draw.height = kSide;
    draw.look = &look;
    OK(context, espWarmUp(context, &draw));
    const int warm = made;
    CHECK(warm > before && cached == made);
    OK(context, espDraw(context, &draw));
    CHECK(made == warm); /* the frame has found all that it needs */

    look.view = ESP_VIEW_NORMALS;
    OK(context, espWarmUp(context, &draw));
    const int views = made;
    CHECK(views > warm);
    OK(context, espDraw(context, &draw));
    CHECK(made == views);

    look.view = ESP_VIEW_SHADED;
    draw.colourFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    draw.scene = &scene;
    OK(context, espWarmUp(context, &draw));
    CHECK(made > views && cached == made);
    const int scenes = made;
    OK(context, espWarmUp(context, &draw));
    CHECK(made == scenes); /* all is there */
    draw.colourFormat = VK_FORMAT_R8_UNORM;
    REFUSED(espWarmUp(context, &draw));

    espDestroy(context);
    size_t bytes = 0;
    CHECK(vkGetPipelineCacheData(device, cache, &bytes, NULL) == VK_SUCCESS);
    printf("%d pipelines, %zu bytes of cache: all checks passed\n", made, bytes);
    vkDestroyPipelineCache(device, cache, NULL);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
    return 0;
}
