// Espalier within Qt Quick 3D: ivy is recorded into the render pass of Qt's window, with its samples and its depth
// buffer. Usage: qt_quick_3d_host MODEL.glb SURFACE.glb GRAMMAR SCENE.qml FOLDER SAMPLES
#include <QGuiApplication>
#include <QQmlContext>
#include <QQuickGraphicsDevice>
#include <QQuickItem>

#include "ivy.hpp"

static int messages = 0;  // of the validation layer

// The same view without and with ivy, as check_pictures.py compares them.
static void takePictures(QGuiApplication& app, QVulkanInstance& instance, const EspHostDevice& host, char** argv) {
    const int samples = atoi(argv[6]);
    QQuick3DGeometry caster;
    fill(caster);
    QQuickView view;
    QSurfaceFormat surface;
    surface.setSamples(samples);
    view.setFormat(surface);
    view.setVulkanInstance(&instance);
    view.setGraphicsDevice(
        QQuickGraphicsDevice::fromDeviceObjects(VkPhysicalDevice(host.physicalDevice), VkDevice(host.device), 0));
    view.rootContext()->setContextProperty("modelFile", QUrl::fromLocalFile(argv[1]));
    view.rootContext()->setContextProperty("shadowCaster", &caster);
    view.setResizeMode(QQuickView::SizeRootObjectToView);
    view.setColor(QColor(0xb8c8d8));
    view.resize(640, 480);
    view.setSource(QUrl::fromLocalFile(argv[4]));
    view.show();
    while (!view.isExposed()) app.processEvents();

    bool ivy = false;
    float exposure = 0;
    const auto picture = [&](const char* name) {
        view.grabWindow();  // what a file loads or a map of shadows takes may come a frame later
        view.grabWindow().save(QString("%1/%2.png").arg(argv[5], name));
    };
    picture("plain");
    QObject::connect(
        &view, &QQuickWindow::beforeRendering, &view,
        [&] {
            if (ivy) prepare(view, samples, exposure);
        },
        Qt::DirectConnection);
    // Connected once the view's own drawing is, and so called after it.
    QObject::connect(
        &view, &QQuickWindow::beforeRenderPassRecording, &view,
        [&] {
            if (ivy) record(view);
        },
        Qt::DirectConnection);
    ivy = true;
    picture("ivy");
    exposure = 2;
    picture("bright_ivy");
    exposure = 0;
    view.rootObject()->setProperty("ball", false);
    picture("ivy_without_object");
    ivy = false;
    picture("plain_without_object");
    view.rootObject()->setProperty("casting", true);
    picture("shadow_alone");
    ivy = true;
    view.rootObject()->setProperty("ball", true);
    picture("all");
}

int main(int argc, char** argv) {
    qputenv("QSG_RENDER_LOOP", "basic");  // one thread, which Espalier's context shares
    QGuiApplication app(argc, argv);
    if (argc != 7) qFatal("usage: qt_quick_3d_host MODEL.glb SURFACE.glb GRAMMAR SCENE.qml FOLDER SAMPLES");
    QVulkanInstance instance;
    instance.setApiVersion(QVersionNumber(1, 3));
    instance.setLayers({"VK_LAYER_KHRONOS_validation"});
    instance.setExtensions({VK_EXT_DEBUG_REPORT_EXTENSION_NAME});
    instance.installDebugOutputFilter(
        [](VkDebugReportFlagsEXT, VkDebugReportObjectTypeEXT, uint64_t, size_t, int32_t, const char*,
           const char* message) { return fprintf(stderr, "%s\n", message), ++messages, true; });
    if (!instance.create()) qFatal("no Vulkan 1.3");
    QQuickWindow::setGraphicsApi(QSGRendererInterface::Vulkan);
    const EspHostDevice host = makeDevice(instance);
    grow(host, argv[2], argv[3]);
    takePictures(app, instance, host, argv);
    uproot(host);
    printf("%d validation messages\n", messages);
    return messages != 0;
}
