// The traversal unit that a slot belongs to, slot % TUS, and its place there, slot / TUS: tables of six
// bits, since with three units a division would be a chain of carries.
module gridrt_slot_unit #(
    parameter int unsigned TUS = 4,
    parameter int unsigned SLOTS = 64,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W,
    localparam int unsigned INDEX_W = (SLOTS / TUS > 1) ? $clog2(SLOTS / TUS) : 1
) (
    input  logic [ SLOT_W-1:0] slot_i,
    output logic [    TUS-1:0] unit_o,  // one of them
    output logic [INDEX_W-1:0] place_o
);
  localparam int unsigned NUMBERS = 1 << SLOT_W;

  function automatic logic [NUMBERS-1:0] of_unit(int unsigned unit);
    for (int unsigned s = 0; s < NUMBERS; s++) of_unit[s] = s % TUS == unit;
  endfunction
  function automatic logic [NUMBERS-1:0] of_place(int unsigned digit);
    for (int unsigned s = 0; s < NUMBERS; s++) of_place[s] = ((s / TUS) >> digit) % 2 == 1;
  endfunction

  for (genvar t = 0; t < TUS; t++) begin : gen_unit
    localparam logic [NUMBERS-1:0] TABLE = of_unit(t);
    assign unit_o[t] = TABLE[slot_i];
  end
  for (genvar i = 0; i < INDEX_W; i++) begin : gen_digit
    localparam logic [NUMBERS-1:0] TABLE = of_place(i);
    assign place_o[i] = TABLE[slot_i];
  end
endmodule
