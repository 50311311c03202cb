/* Ivy on a wall behind Vulkan's cube, for cube.patch. Environment: IVY names a surface and a grammar, divided by a space; BRIGHT
 * brightens the ivy. */
#include <espalier/espalier.h>

static EspContext *ivy;

static void must(EspResult result) {
    if (result == ESP_OK) return;
    fprintf(stderr, "espalier: %s\n", espLastError(ivy));
    exit(1);
}

/* Adds what Espalier needs to what the cube asks for, and keeps the def until the context is made. */
static VkDeviceCreateInfo *ivyDevice(VkDeviceCreateInfo *info) {
    static const char *names[64];
    uint32_t required = 0, count = 0;
    const char *const *ours = espRequiredExtensions(&required);
    for (; count < info->enabledExtensionCount; ++count) names[count] = info->ppEnabledExtensionNames[count];
    for (uint32_t i = 0; i < required; ++i) names[count++] = ours[i];
    info->pNext = espRequiredFeatures();
    info->ppEnabledExtensionNames = names;
    info->enabledExtensionCount = count;
    return info;
}

static char *readText(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    char *text = malloc(1 << 20);
    *size = fread(text, 1, 1 << 20, file);
    fclose(file);
    return text;
}

static void ivyGrow(const struct demo *demo, VkDeviceCreateInfo *info) {
    char surface[512], grammar[512];
    if (!getenv("IVY") || sscanf(getenv("IVY"), "%511s %511s", surface, grammar) != 2) return;
    VkQueue queue;
    vkGetDeviceQueue(demo->device, demo->graphics_queue_family_index, 0, &queue);
    EspHostDevice host = {.structSize = sizeof host, .queueFamily = demo->graphics_queue_family_index,
                          .getInstanceProcAddr = (void *)vkGetInstanceProcAddr, .instance = demo->inst,
                          .physicalDevice = demo->gpu, .device = demo->device, .queue = queue, .deviceInfo = info};
    EspContextDef def = {.structSize = sizeof def};
    espDefaultContextDef(&def);
    def.host = &host;
    must(espCreate(ESP_VERSION, &def, &ivy));
    /* Six metres wide and high, two metres behind the cube's middle. */
    EspTransform place = {{{6, 0, 0, -3}, {0, 6, 0, -3}, {0, 0, 6, -2}}};
    EspSurface wall;
    must(espLoadSurface(ivy, surface, &place, &wall));
    EspGrammarDef rules = {.structSize = sizeof rules, .name = grammar};
    rules.text = readText(grammar, &rules.length);
    EspSeedDef seed = {.structSize = sizeof seed};
    espDefaultSeedDef(&seed);
    must(espCompileGrammar(ivy, &rules, &seed.grammar));
    free((void *)rules.text);
    for (int i = 0; i < 5; ++i) {
        seed.position[0] = 1.2f * (float)(i - 2), seed.position[1] = -2.9f, seed.position[2] = -2;
        seed.direction[1] = 1;
        seed.number = (uint32_t)i;
        EspSeed planted;
        must(espPlant(ivy, &seed, &planted));
    }
    must(espUpdate(ivy));
}

/* In front of the cube's pass. The cube's buffers are recorded once and submitted again and again. */
static void ivyPrepare(const struct demo *demo, VkCommandBuffer commands) {
    if (!ivy) return;
    const uint32_t colour = demo->format;
    EspLook look = {.structSize = sizeof look};
    espDefaultLook(&look);
    look.exposure = getenv("BRIGHT") ? 2 : 0;
    EspPassFormat format = {.structSize = sizeof format};
    espDefaultPassFormat(&format);
    format.colourFormats = &colour, format.colourCount = 1;
    format.depthFormat = demo->depth.format, format.renderPass = demo->render_pass;
    EspPassDef pass = {.structSize = sizeof pass};
    espDefaultPassDef(&pass);
    pass.format = &format, pass.look = &look, pass.commandBuffer = commands;
    memcpy(pass.view, demo->view_matrix, sizeof pass.view);
    memcpy(pass.projection, demo->projection_matrix, sizeof pass.projection);
    const float side = (float)(demo->width < demo->height ? demo->width : demo->height);
    pass.viewport[0] = ((float)demo->width - side) / 2, pass.viewport[1] = ((float)demo->height - side) / 2;
    pass.viewport[2] = pass.viewport[3] = side;
    static uint64_t frame = 0;
    pass.frame = ++frame;
    must(espPrepare(ivy, &pass));
}

static void ivyRecord(VkCommandBuffer commands) {
    if (ivy) must(espRecord(ivy, commands));
}
