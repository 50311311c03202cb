// Ivy for a window of Qt Quick's: all that a game of Qt's needs of Espalier.
#include "ivy.hpp"

#include <QFile>
#include <QMatrix4x4>
#include <QQuickItem>
#include <QSGRendererInterface>

static EspContext* context = nullptr;

static void must(EspResult result) {
    if (result != ESP_OK) qFatal("espalier: %s", espLastError(context));
}

static void* resource(QQuickWindow& window, QSGRendererInterface::Resource kind) {
    return *static_cast<void**>(window.rendererInterface()->getResource(&window, kind));
}

// Qt works on a device that has what Espalier needs besides what Qt asks for.
EspHostDevice makeDevice(QVulkanInstance& instance) {
    static VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    uint32_t one = 1, count = 0;
    VkPhysicalDevice physical;
    vkEnumeratePhysicalDevices(instance.vkInstance(), &one, &physical);
    const char* const* required = espRequiredExtensions(&count);
    static QList<const char*> extensions(required, required + count);
    extensions << VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    static const float priority = 1;
    static VkDeviceQueueCreateInfo queueInfo = {
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    info.pNext = espRequiredFeatures();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    EspHostDevice host = {};
    host.structSize = sizeof host;
    host.getInstanceProcAddr = reinterpret_cast<void*>(instance.getInstanceProcAddr("vkGetInstanceProcAddr"));
    host.instance = instance.vkInstance();
    host.physicalDevice = physical;
    host.deviceInfo = &info;
    VkDevice device;
    if (vkCreateDevice(physical, &info, nullptr, &device) != VK_SUCCESS) qFatal("no device");
    VkQueue queue;
    vkGetDeviceQueue(device, 0, 0, &queue);
    host.device = device;
    host.queue = queue;
    return host;
}

void grow(const EspHostDevice& host, const char* surface, const char* grammar) {
    EspContextDef def;
    espDefaultContextDef(&def);
    def.host = &host;
    must(espCreate(ESP_VERSION, &def, &context));
    EspSurface wall;
    must(espLoadSurface(context, surface, nullptr, &wall));
    QFile file(grammar);
    if (!file.open(QIODevice::ReadOnly)) qFatal("can't read %s", grammar);
    const QByteArray text = file.readAll();
    const EspGrammarDef grammarDef = {sizeof grammarDef, grammar, text.data(), size_t(text.size())};
    EspGrammar ivy;
    must(espCompileGrammar(context, &grammarDef, &ivy));
    for (float x : {-2.45f, -1.05f, -.42f, 1.6f, 2.45f}) {
        EspSeedDef seed;
        espDefaultSeedDef(&seed);
        seed.grammar = ivy;
        seed.position[0] = x, seed.position[1] = .1f, seed.position[2] = .42f;
        seed.direction[0] = .1f, seed.direction[2] = -1;
        EspSeed planted;
        must(espPlant(context, &seed, &planted));
    }
    must(espUpdate(context));
}

void fill(QQuick3DGeometry& caster) {
    EspTriangles triangles = {};
    triangles.structSize = sizeof triangles;
    must(espMaterialise(context, &triangles));
    caster.setVertexData(
        QByteArray(static_cast<const char*>(triangles.vertices), qsizetype(triangles.vertexCount) * 16));
    caster.setIndexData(
        QByteArray(reinterpret_cast<const char*>(triangles.indices), qsizetype(triangles.indexCount) * 4));
    caster.setStride(16);
    caster.setBounds({-10, -1, -10}, {10, 10, 10});
    caster.addAttribute(QQuick3DGeometry::Attribute::PositionSemantic, 0, QQuick3DGeometry::Attribute::F32Type);
    caster.addAttribute(QQuick3DGeometry::Attribute::IndexSemantic, 0, QQuick3DGeometry::Attribute::U32Type);
}

void prepare(QQuickView& view, int samples, float exposure) {
    static uint64_t frame = 0;
    const QObject* camera = view.rootObject()->property("camera").value<QObject*>();
    const QObject* sun = view.rootObject()->property("sun").value<QObject*>();
    EspLook look;
    espDefaultLook(&look);
    look.exposure = exposure;
    const QVector3D towardsSun = -sun->property("forward").value<QVector3D>();
    for (int i = 0; i < 3; ++i) look.sunDirection[i] = towardsSun[i];
    const uint32_t colour = VK_FORMAT_B8G8R8A8_UNORM;
    EspPassFormat format;
    espDefaultPassFormat(&format);
    format.colourFormats = &colour, format.colourCount = 1;
    format.depthFormat = VK_FORMAT_D24_UNORM_S8_UINT, format.samples = uint32_t(samples);
    format.renderPass = resource(view, QSGRendererInterface::RenderPassResource);
    EspPassDef pass;
    espDefaultPassDef(&pass);
    const QSize size = view.size() * view.effectiveDevicePixelRatio();
    const float near = camera->property("clipNear").toFloat(), far = camera->property("clipFar").toFloat();
    QMatrix4x4 projection(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, .5f, .5f, 0, 0, 0, 1);  // to Vulkan's clip space
    projection.perspective(camera->property("fieldOfView").toFloat(), float(size.width()) / float(size.height()), near,
                           far);
    const QMatrix4x4 eye = camera->property("sceneTransform").value<QMatrix4x4>().inverted();
    memcpy(pass.view, eye.constData(), sizeof pass.view);
    memcpy(pass.projection, projection.constData(), sizeof pass.projection);
    pass.viewport[2] = float(size.width()), pass.viewport[3] = float(size.height());
    pass.format = &format, pass.look = &look;
    pass.commandBuffer = resource(view, QSGRendererInterface::CommandListResource);
    pass.frame = ++frame, pass.framesDone = frame > 3 ? frame - 3 : 0;  // Qt has two frames in flight
    must(espPrepare(context, &pass));
}

void record(QQuickWindow& window) {
    window.beginExternalCommands();
    must(espRecord(context, resource(window, QSGRendererInterface::CommandListResource)));
    window.endExternalCommands();
}

void uproot(const EspHostDevice& host) {
    espDestroy(context);
    vkDestroyDevice(VkDevice(host.device), nullptr);
}
