// The clock of the ECP5's configuration flash, for the linter.
module USRMCLK (
    input logic USRMCLKI,
    input logic USRMCLKTS
);
  logic unused;
  assign unused = &{1'b0, USRMCLKI, USRMCLKTS};
endmodule
