/* Espalier in a window of SDL2's, loaded when the program runs. Draws until the window is closed, or 30 frames under a
 * script. Usage: sdl2_host LIBRARY SURFACE.glb GRAMMAR [FRAMES] */
#include <SDL.h>
#include <SDL_vulkan.h>
#include <dlfcn.h>
#include <espalier/espalier.h>
#include <stdio.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

enum { MAX_IMAGES = 8 };

static void fail(const char* what, const char* why) {
    fprintf(stderr, "sdl2_host: %s: %s\n", what, why);
    exit(1);
}

/* Each function is looked up by its name; its type is the header's. */
static void* library;
static void* find(const char* name) {
    void* found = dlsym(library, name);
    if (!found) fail(name, dlerror());
    return found;
}
#define ESP(name) ((__typeof__(&name))find(#name))

static EspContext* context;
static void must(EspResult result) {
    if (result != ESP_OK) fail("espalier", ESP(espLastError)(context));
}
static void vk(VkResult result) {
    if (result < 0) fail("vulkan", "a call failed");
}

static VkInstance instance;
static VkPhysicalDevice physical;
static VkDevice device;
static VkQueue queue;
static VkSurfaceKHR surface;
static VkSwapchainKHR swapchain;
static VkImage images[MAX_IMAGES];
static VkImageView views[MAX_IMAGES];

static EspHostDevice makeDevice(SDL_Window* window) {
    static const char* extensions[16]; /* espCreate reads the names again */
    unsigned count = 16;
    if (!SDL_Vulkan_GetInstanceExtensions(window, &count, extensions)) fail("SDL", SDL_GetError());
    VkApplicationInfo app = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo made = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &app,
                                 .enabledExtensionCount = count,
                                 .ppEnabledExtensionNames = extensions};
    vk(vkCreateInstance(&made, NULL, &instance));
    if (!SDL_Vulkan_CreateSurface(window, instance, &surface)) fail("SDL", SDL_GetError());
    uint32_t one = 1, required = 0;
    vk(vkEnumeratePhysicalDevices(instance, &one, &physical));
    const char* const* names = ESP(espRequiredExtensions)(&required);
    for (count = 0; count < required; ++count) extensions[count] = names[count];
    extensions[count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    static const float priority = 1;
    static VkDeviceQueueCreateInfo queues = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    static VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queues};
    info.pNext = ESP(espRequiredFeatures)();
    info.enabledExtensionCount = count;
    info.ppEnabledExtensionNames = extensions;
    vk(vkCreateDevice(physical, &info, NULL, &device));
    vkGetDeviceQueue(device, 0, 0, &queue);
    return (EspHostDevice){.structSize = sizeof(EspHostDevice),
                           .getInstanceProcAddr = SDL_Vulkan_GetVkGetInstanceProcAddr(),
                           .instance = instance,
                           .physicalDevice = physical,
                           .device = device,
                           .queue = queue,
                           .deviceInfo = &info};
}

static void makeSwapchain(uint32_t width, uint32_t height) {
    VkSwapchainCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                     .surface = surface,
                                     .minImageCount = 3,
                                     .imageFormat = VK_FORMAT_B8G8R8A8_UNORM,
                                     .imageExtent = {width, height},
                                     .imageArrayLayers = 1,
                                     .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                     .preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR,
                                     .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                     .presentMode = VK_PRESENT_MODE_FIFO_KHR};
    VkBool32 presents;
    vk(vkGetPhysicalDeviceSurfaceSupportKHR(physical, 0, surface, &presents));
    vk(vkCreateSwapchainKHR(device, &info, NULL, &swapchain));
    uint32_t count = MAX_IMAGES;
    vk(vkGetSwapchainImagesKHR(device, swapchain, &count, images));
    for (uint32_t i = 0; i < count; ++i) {
        VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                      .image = images[i],
                                      .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                      .format = info.imageFormat,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        vk(vkCreateImageView(device, &view, NULL, &views[i]));
    }
}

static void grow(const EspHostDevice* host, const char* file, const char* grammar) {
    EspContextDef def = {.structSize = sizeof def};
    ESP(espDefaultContextDef)(&def);
    def.host = host;
    must(ESP(espCreate)(ESP_VERSION, &def, &context));
    EspSurface wall;
    must(ESP(espLoadSurface)(context, file, NULL, &wall));
    size_t size;
    char* text = SDL_LoadFile(grammar, &size);
    if (!text) fail(grammar, SDL_GetError());
    EspGrammarDef rules = {.structSize = sizeof rules, .name = grammar, .text = text, .length = size};
    EspSeedDef seed = {.structSize = sizeof seed};
    ESP(espDefaultSeedDef)(&seed);
    must(ESP(espCompileGrammar)(context, &rules, &seed.grammar));
    SDL_free(text);
    seed.position[0] = -1.05f, seed.position[1] = .1f, seed.position[2] = .42f, seed.direction[2] = -1;
    EspSeed planted;
    must(ESP(espPlant)(context, &seed, &planted));
}

static void drawFrame(VkCommandBuffer commands, VkFence fence, VkSemaphore acquired, VkSemaphore drawn,
                      uint64_t frame) {
    uint32_t image;
    vk(vkAcquireNextImageKHR(device, swapchain, UINT64_MAX, acquired, VK_NULL_HANDLE, &image));
    must(ESP(espUpdate)(context));
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vk(vkBeginCommandBuffer(commands, &begin));
    EspDrawDef draw = {.structSize = sizeof draw};
    ESP(espDefaultDrawDef)(&draw);
    draw.width = 640, draw.height = 480, draw.commandBuffer = commands;
    draw.colourImage = images[image], draw.colourView = views[image], draw.colourFormat = VK_FORMAT_B8G8R8A8_UNORM;
    draw.colourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    draw.frame = frame, draw.framesDone = frame - 1;
    must(ESP(espDraw)(context, &draw));
    VkImageMemoryBarrier show = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                 .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                 .oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                 .newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                 .image = images[image],
                                 .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                         0, 0, NULL, 0, NULL, 1, &show);
    vk(vkEndCommandBuffer(commands));
    VkPipelineStageFlags wait = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .waitSemaphoreCount = 1,
                           .pWaitSemaphores = &acquired,
                           .pWaitDstStageMask = &wait,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands,
                           .signalSemaphoreCount = 1,
                           .pSignalSemaphores = &drawn};
    vk(vkQueueSubmit(queue, 1, &submit, fence));
    VkPresentInfoKHR present = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                .waitSemaphoreCount = 1,
                                .pWaitSemaphores = &drawn,
                                .swapchainCount = 1,
                                .pSwapchains = &swapchain,
                                .pImageIndices = &image};
    vk(vkQueuePresentKHR(queue, &present));
    vk(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX));
    vk(vkResetFences(device, 1, &fence));
}

int main(int argc, char** argv) {
    if (argc < 4) fail("usage", "sdl2_host LIBRARY SURFACE.glb GRAMMAR [FRAMES]");
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) fail(argv[1], dlerror());
    if (SDL_Init(SDL_INIT_VIDEO)) fail("SDL", SDL_GetError());
    SDL_Window* window = SDL_CreateWindow("SDL2 with Espalier", 0, 0, 640, 480, SDL_WINDOW_VULKAN);
    if (!window) fail("SDL", SDL_GetError());
    EspHostDevice host = makeDevice(window);
    makeSwapchain(640, 480);
    grow(&host, argv[2], argv[3]);
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT};
    VkCommandBufferAllocateInfo one = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                       .commandBufferCount = 1};
    vk(vkCreateCommandPool(device, &pool, NULL, &one.commandPool));
    VkCommandBuffer commands;
    vk(vkAllocateCommandBuffers(device, &one, &commands));
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkFenceCreateInfo unsignalled = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkSemaphore acquired, drawn;
    VkFence fence;
    vk(vkCreateSemaphore(device, &semaphore, NULL, &acquired));
    vk(vkCreateSemaphore(device, &semaphore, NULL, &drawn));
    vk(vkCreateFence(device, &unsignalled, NULL, &fence));
    const uint64_t frames = argc > 4 ? strtoull(argv[4], NULL, 10) : UINT64_MAX;
    SDL_Event event = {0};
    for (uint64_t frame = 1; frame <= frames && event.type != SDL_QUIT; ++frame) {
        drawFrame(commands, fence, acquired, drawn, frame);
        while (SDL_PollEvent(&event) && event.type != SDL_QUIT) {
        }
    }
    vkQueueWaitIdle(queue);
    EspStats stats = {.structSize = sizeof stats};
    must(ESP(espReadStats)(context, &stats));
    printf("%llu nodes, %llu leaves drawn\n", (unsigned long long)stats.nodes, (unsigned long long)stats.drawnLeaves);
    ESP(espDestroy)(context);
    return 0;
}
