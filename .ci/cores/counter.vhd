-- A counter with an enable.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity counter is
  generic (BITS : positive := 4);
  port (clk : in std_logic; enable : in std_logic; count : out std_logic_vector(BITS - 1 downto 0));
end entity;

architecture rtl of counter is
  signal value : unsigned(BITS - 1 downto 0) := (others => '0');
begin
  process (clk)
  begin
    if rising_edge(clk) then
      if enable = '1' then
        value <= value + 1;
      end if;
    end if;
  end process;
  count <= std_logic_vector(value);
end architecture;
