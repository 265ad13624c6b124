-- Puts a line of rows.txt on the inputs right after each edge, and the first before all.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

entity tb is end entity;

architecture sim of tb is
  signal clk, rst : std_logic := '0';
  signal a, opposite, share, rest, modulus, size : signed(7 downto 0) := (others => '0');
  signal steps : unsigned(3 downto 0);
  signal sum : std_logic_vector(11 downto 0);
  signal product : signed(15 downto 0);
begin
  dut : entity work.filter port map (clk, rst, a, steps, sum, product, opposite, share, rest, modulus, size);
  process
    file rows : text open read_mode is "all_rows.txt";
    variable row : line;
    variable reset : std_logic;
    variable value : std_logic_vector(7 downto 0);
    procedure next_row is
    begin
      readline(rows, row);
      read(row, reset);
      read(row, value);
      rst <= reset;
      a <= signed(value);
    end procedure;
  begin
    next_row;
    wait for 10 ns;
    while not endfile(rows) loop
      clk <= '1';
      wait for 1 ns;
      next_row;
      wait for 4 ns;
      clk <= '0';
      wait for 5 ns;
    end loop;
    wait;
  end process;
end architecture;
