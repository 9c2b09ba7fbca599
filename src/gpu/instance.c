// The Vulkan instance, with the validation layer when asked for.
//
// Validation includes synchronization validation: every barrier of roil is derived, so a missing
// one is a bug here and never the caller's.
#include "base/log.h"
#include "base/memory.h"
#include "gpu/vk.h"
#include <string.h>

enum { MAX_WINDOW_EXTENSIONS = 8 };

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

static bool layer_exists(const vk_calls *vk, const char *name) {
    VkLayerProperties list[64];
    uint32_t count = COUNT_OF(list);
    VkResult result = vk->EnumerateInstanceLayerProperties(&count, list);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(list[i].layerName, name) == 0) return true;
    }
    return false;
}

static bool extension_exists(const vk_calls *vk, const char *layer, const char *name) {
    VkExtensionProperties list[128];
    uint32_t count = COUNT_OF(list);
    VkResult result = vk->EnumerateInstanceExtensionProperties(layer, &count, list);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(list[i].extensionName, name) == 0) return true;
    }
    return false;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user) {
    (void)types;
    _Atomic uint64_t *messages = user;
    atomic_fetch_add(messages, 1);
    bool error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
    log_write(error ? LOG_ERROR : LOG_WARNING, "vulkan validation: %s", data->pMessage);
    return VK_FALSE;
}

static const VkValidationFeatureEnableEXT validation_enables[] = {
    VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
static const VkValidationFeaturesEXT validation_features = {
    .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
    .enabledValidationFeatureCount = COUNT_OF(validation_enables),
    .pEnabledValidationFeatures = validation_enables};

static bool version_is_enough(const vk_calls *vk) {
    uint32_t version = VK_API_VERSION_1_0;
    if (vk->EnumerateInstanceVersion(&version) != VK_SUCCESS || version < VK_API_VERSION_1_3) {
        return err_set("the Vulkan loader is version %u.%u; roil needs 1.3 or later",
                       VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
    }
    return true;
}

static bool window_extensions_exist(const vk_calls *vk, const gpu_window *window) {
    if (window->extension_count > MAX_WINDOW_EXTENSIONS) {
        return err_set("the window needs %u Vulkan extensions; at most %d are accepted",
                       window->extension_count, MAX_WINDOW_EXTENSIONS);
    }
    for (uint32_t i = 0; i < window->extension_count; i++) {
        if (extension_exists(vk, NULL, window->extensions[i])) continue;
        return err_set("no Vulkan driver can show pictures in this window: %s is missing",
                       window->extensions[i]);
    }
    return true;
}

static bool create(vk_instance *out, const vk_calls *vk, const gpu_window *window,
                   const VkDebugUtilsMessengerCreateInfoEXT *messenger) {
    const char *extensions[2 + MAX_WINDOW_EXTENSIONS], *layers[1];
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &(VkApplicationInfo){.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                                 .pApplicationName = "roil",
                                                 .pEngineName = "roil",
                                                 .apiVersion = VK_API_VERSION_1_3},
        .ppEnabledExtensionNames = extensions,
        .ppEnabledLayerNames = layers,
    };
    for (uint32_t i = 0; window && i < window->extension_count; i++) {
        extensions[info.enabledExtensionCount++] = window->extensions[i];
    }
    if (out->labels) {
        extensions[info.enabledExtensionCount++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    }
    if (out->validating) {
        layers[info.enabledLayerCount++] = validation_layer;
        info.pNext = messenger;
        if (extension_exists(vk, validation_layer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
            extensions[info.enabledExtensionCount++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
        }
    }
    VkResult result = vk->CreateInstance(&info, NULL, &out->handle);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return err_set("no Vulkan driver is installed; install the driver of your GPU, or Mesa's "
                       "software driver (Debian: mesa-vulkan-drivers)");
    }
    if (result != VK_SUCCESS) {
        return err_set("Vulkan does not start: vkCreateInstance gives error %d", (int)result);
    }
    return true;
}

bool vk_instance_create(vk_instance *out, vk_calls *vk, bool validate, const gpu_window *window,
                        _Atomic uint64_t *messages) {
    memset(out, 0, sizeof *out);
    if (!vk_calls_find_global(vk, NULL) || !version_is_enough(vk)) return false;
    if (window && !window_extensions_exist(vk, window)) return false;
    out->labels = extension_exists(vk, NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    out->validating = validate && out->labels && layer_exists(vk, validation_layer);
    if (validate && !out->validating) {
        log_write(LOG_WARNING, "%s is not installed: running without validation", validation_layer);
    }
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .pNext = &validation_features,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = messages,
    };
    if (!create(out, vk, window, &messenger)) return false;
    if (!vk_calls_find_instance(vk, out->handle)) return false;
    if (!out->validating) return true;

    messenger.pNext = NULL;
    if (!vk->CreateDebugUtilsMessengerEXT ||
        vk->CreateDebugUtilsMessengerEXT(out->handle, &messenger, NULL, &out->messenger) !=
            VK_SUCCESS) {
        vk_instance_destroy(out, vk);
        return err_set("the validation layer takes no messenger");
    }
    return true;
}

void vk_instance_destroy(vk_instance *instance, const vk_calls *vk) {
    if (instance->messenger)
        vk->DestroyDebugUtilsMessengerEXT(instance->handle, instance->messenger, NULL);
    if (instance->handle && vk->DestroyInstance) vk->DestroyInstance(instance->handle, NULL);
    memset(instance, 0, sizeof *instance);
}
