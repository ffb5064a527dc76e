// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0
// A GPIO chip of eight pins and a pulse per second, without hardware, for kernels without gpio-sim (Debian's).
//
//     /sys/devices/platform/hilcam-pins/pull    write "PIN LEVEL": drives an input from outside
//     /sys/devices/platform/hilcam-pins/levels  read: the levels of all pins, bit n is pin n
//     /dev/ppsN                                 a pulse each second

#include <linux/gpio/driver.h>
#include <linux/interrupt.h>
#include <linux/irq.h>
#include <linux/irqdomain.h>
#include <linux/module.h>
#include <linux/platform_device.h>
#include <linux/pps_kernel.h>
#include <linux/timer.h>

#define PINS 8

static struct platform_device* device;
static struct irq_domain* irqs;
static unsigned long pulled, driven,
    outputs; /* by pin: level from outside, level of an output, is an output */
static struct pps_device* pulse;
static struct timer_list second;

static int pin_get(struct gpio_chip* chip, unsigned int pin) {
    return test_bit(pin, test_bit(pin, &outputs) ? &driven : &pulled);
}

static void pin_set(struct gpio_chip* chip, unsigned int pin, int level) { assign_bit(pin, &driven, level); }

static int pin_direction(struct gpio_chip* chip, unsigned int pin) {
    return test_bit(pin, &outputs) ? GPIO_LINE_DIRECTION_OUT : GPIO_LINE_DIRECTION_IN;
}

static int pin_input(struct gpio_chip* chip, unsigned int pin) {
    clear_bit(pin, &outputs);
    return 0;
}

static int pin_output(struct gpio_chip* chip, unsigned int pin, int level) {
    pin_set(chip, pin, level);
    set_bit(pin, &outputs);
    return 0;
}

/* Interrupts that nothing raises but pull_store(). */
static void nothing(struct irq_data* data) {}

static int take_type(struct irq_data* data, unsigned int type) { return IRQ_SET_MASK_OK; /* keep it */ }

static struct irq_chip edges = {
    .name = "hilcam-pins",
    .irq_mask = nothing,
    .irq_unmask = nothing,
    .irq_ack = nothing,
    .irq_set_type = take_type,
};

static int map_irq(struct irq_domain* domain, unsigned int irq, irq_hw_number_t pin) {
    irq_set_chip_and_handler(irq, &edges, handle_simple_irq);
    return 0;
}

static const struct irq_domain_ops irq_ops = {.map = map_irq};

static int pin_irq(struct gpio_chip* chip, unsigned int pin) { return irq_create_mapping(irqs, pin); }

static struct gpio_chip pins = {
    .label = "hilcam-pins",
    .owner = THIS_MODULE,
    .base = -1,
    .ngpio = PINS,
    .get = pin_get,
    .set = pin_set,
    .get_direction = pin_direction,
    .direction_input = pin_input,
    .direction_output = pin_output,
    .to_irq = pin_irq,
};

static ssize_t pull_store(struct device* dev, struct device_attribute* attr, const char* text, size_t size) {
    unsigned int pin, level, irq, type;

    if (sscanf(text, "%u %u", &pin, &level) != 2 || pin >= PINS || level > 1) return -EINVAL;
    if (test_bit(pin, &pulled) == level) return size;
    assign_bit(pin, &pulled, level);
    irq = irq_find_mapping(irqs, pin);
    if (!irq) return size;
    type = irq_get_trigger_type(irq);
    if (type & (level ? IRQ_TYPE_EDGE_RISING : IRQ_TYPE_EDGE_FALLING)) generic_handle_irq_safe(irq);
    return size;
}
static DEVICE_ATTR_WO(pull);

static ssize_t levels_show(struct device* dev, struct device_attribute* attr, char* text) {
    return sprintf(text, "%lu\n", (driven & outputs) | (pulled & ~outputs));
}
static DEVICE_ATTR_RO(levels);

static struct attribute* attributes[] = {&dev_attr_pull.attr, &dev_attr_levels.attr, NULL};
static const struct attribute_group group = {.attrs = attributes};

static void second_over(struct timer_list* timer) {
    struct pps_event_time now;

    pps_get_ts(&now);
    pps_event(pulse, &now, PPS_CAPTUREASSERT, NULL);
    mod_timer(timer, jiffies + HZ);
}

static struct pps_source_info source = {
    .name = "hilcam-pins",
    .mode = PPS_CAPTUREASSERT | PPS_OFFSETASSERT | PPS_CANWAIT | PPS_TSFMT_TSPEC,
    .owner = THIS_MODULE,
};

static void remove_irqs(void) {
    unsigned int pin;

    for (pin = 0; pin < PINS; ++pin) irq_dispose_mapping(irq_find_mapping(irqs, pin));
    irq_domain_remove(irqs);
}

static int __init pins_begin(void) {
    int status;

    device = platform_device_register_simple("hilcam-pins", PLATFORM_DEVID_NONE, NULL, 0);
    if (IS_ERR(device)) return PTR_ERR(device);
    irqs = irq_domain_add_linear(NULL, PINS, &irq_ops, NULL);
    if (!irqs) {
        status = -ENOMEM;
        goto no_irqs;
    }
    pins.parent = &device->dev;
    status = gpiochip_add_data(&pins, NULL);
    if (status) goto no_chip;
    status = sysfs_create_group(&device->dev.kobj, &group);
    if (status) goto no_group;
    pulse = pps_register_source(&source, PPS_CAPTUREASSERT | PPS_OFFSETASSERT);
    if (IS_ERR(pulse)) {
        status = PTR_ERR(pulse);
        goto no_pulse;
    }
    timer_setup(&second, second_over, 0);
    mod_timer(&second, jiffies + HZ);
    return 0;

no_pulse:
    sysfs_remove_group(&device->dev.kobj, &group);
no_group:
    gpiochip_remove(&pins);
no_chip:
    remove_irqs();
no_irqs:
    platform_device_unregister(device);
    return status;
}

static void __exit pins_end(void) {
    del_timer_sync(&second);
    pps_unregister_source(pulse);
    sysfs_remove_group(&device->dev.kobj, &group);
    gpiochip_remove(&pins);
    remove_irqs();
    platform_device_unregister(device);
}

module_init(pins_begin);
module_exit(pins_end);
MODULE_LICENSE("GPL");
MODULE_DESCRIPTION("GPIO pins and a pulse per second without hardware");
